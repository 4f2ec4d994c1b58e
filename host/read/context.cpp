#include "read/context.h"

#include "base/log.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

namespace opal {

namespace {

constexpr size_t most_told = 20; // a screen's worth

} // namespace

void Mistakes::throw_all() const {
    std::vector<Mistake> sorted = list_;
    std::map<std::string, size_t> files; // in the order of their first mistakes
    for (const Mistake &mistake : sorted)
        files.emplace(mistake.at.file, files.size());
    std::stable_sort(sorted.begin(), sorted.end(), [&](const Mistake &a, const Mistake &b) {
        return std::tuple(files.at(a.at.file), a.at.line, a.at.column) <
               std::tuple(files.at(b.at.file), b.at.line, b.at.column);
    });
    std::vector<std::string> lines;
    for (const Mistake &mistake : sorted)
        lines.push_back(mistake.text);
    if (const size_t count = lines.size(); count > most_told) {
        lines.resize(most_told);
        const size_t more = count - most_told;
        lines.push_back(fmt::format("... and {} more mistake{}", more, more == 1 ? "" : "s"));
    }
    if (lines.size() == 1)
        throw Error(lines[0]);
    if (!lines.empty())
        throw ErrorList(lines);
}

void ParseContext::mistake(const SourcePlace &place, const std::string &message) const {
    const XmlError error(place, message);
    if (!mistakes)
        throw error;
    mistakes->add(place, error.what());
}

MistakeHandler ParseContext::handler() const {
    return [this](const SourcePlace &place, const std::string &message) { mistake(place, message); };
}

void ParseContext::unknown(const XmlNode &node, const std::string &message) const {
    if (lenient)
        warn(node.place().text() + ": " + message);
    else
        mistake(node, message);
}

bool ParseContext::require_attributes(const XmlNode &node, std::initializer_list<const char *> names,
                                      std::initializer_list<const char *> optional) const {
    const auto take_unknown = [&](const std::string &name, const std::string &message) {
        if (is_leftover && is_leftover(node, name))
            note(fmt::format("{}: attribute '{}' of <{}> means nothing here", node.place().text(), name, node.tag()));
        else
            unknown(node, message);
    };
    return node.require_attributes(names, handler(), take_unknown, optional);
}

void ParseContext::gather(const SourcePlace &place, const Error &error) const {
    if (!mistakes)
        throw; // the exception that attempt() handles
    const auto *placed = dynamic_cast<const XmlError *>(&error);
    mistakes->add(placed ? placed->place() : place, error.what());
}

} // namespace opal
