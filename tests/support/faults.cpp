#include "support/faults.h"

#include "base/error.h"
#include "base/json.h"
#include "image/image.h"

#include <catch2/catch.hpp>

#include <algorithm>

#include <fmt/format.h>

namespace opal::test {

namespace fs = std::filesystem;

namespace {

constexpr const char *outputs[] = {"o.exr", "o.png", "o.json"};
constexpr const char *old_text = "old";
enum class State { none, old, whole, damaged };

bool is_whole(const fs::path &file, const std::string &text) {
    using namespace std::string_literals;
    if (file.extension() == ".json")
        return nlohmann::json::accept(text);
    if (file.extension() == ".png")
        return text.starts_with("\x89PNG") && text.ends_with("IEND\xae\x42\x60\x82"s);
    try {
        return read_exr(file).width == 8;
    } catch (const Error &) {
        return false;
    }
}

State state_of(const fs::path &file) {
    if (!fs::exists(file))
        return State::none;
    const std::string text = read_text(file);
    return text == old_text ? State::old : is_whole(file, text) ? State::whole : State::damaged;
}

bool holds_temporary_file(const fs::path &folder) {
    return std::any_of(fs::directory_iterator(folder), fs::directory_iterator(), [](const fs::directory_entry &entry) {
        return entry.path().filename().string().starts_with(".opal-");
    });
}

} // namespace

const std::vector<std::string> &fault_names() {
    static const std::vector<std::string> names = {"EIO", "ENOSPC", "EINTR", "short", "KILL", "TERM", "INT"};
    return names;
}

std::string with_fault(const fs::path &folder, const std::string &fault, long call, const fs::path &log) {
    return fmt::format("LD_PRELOAD={} OPAL_FAULT_FOLDER={} OPAL_FAULT={}@{} OPAL_FAULT_LOG={} ", OPAL_FAULTS,
                       folder.string(), fault, call, log.empty() ? "/dev/null" : log.string());
}

long lines_in(const fs::path &file) {
    const std::string text = read_text(file);
    return long(std::count(text.begin(), text.end(), '\n'));
}

FaultyRender::FaultyRender(bool over_old_files) : over_old_files_(over_old_files) {
    folder_.write("light.obj", "v -9 -9 5\nv 9 -9 5\nv 0 9 5\nf 1 3 2\n");
    folder_.write("s.xml", "<scene><integrator type='path_mis'/><camera type='perspective'><integer name='width' "
                           "value='8'/><integer name='height' value='8'/></camera><mesh type='obj'><string "
                           "name='filename' value='light.obj'/><emitter type='area'><color name='radiance' value='1 1 "
                           "1'/></emitter></mesh></scene>");
    const ScratchFolder beside;
    REQUIRE(broken_by("none", 0).empty()); // the kernel is in the cache from now on
    prepare();
    run_shell(with_fault(folder_.path(), "none", 0, beside / "log") + OPAL_BINARY " render " +
              (folder_ / "s.xml").string() + " --spp 1 -o " + (folder_ / "o.exr").string() + " --json " +
              (folder_ / "o.json").string());
    calls_ = lines_in(beside / "log");
    REQUIRE(calls_ > 30);
}

void FaultyRender::prepare() const {
    for (const auto &entry : fs::directory_iterator(folder_.path()))
        if (entry.path().filename() != "s.xml" && entry.path().filename() != "light.obj")
            fs::remove(entry);
    for (const char *name : outputs)
        if (over_old_files_)
            folder_.write(name, old_text);
}

std::string FaultyRender::broken_by(const std::string &fault, long call) const {
    prepare();
    const Outcome outcome =
        run_shell(with_fault(folder_.path(), fault, call) + "timeout -k 1 10 " OPAL_BINARY " render " +
                  (folder_ / "s.xml").string() + " --spp 1 -o " + (folder_ / "o.exr").string() + " --json " +
                  (folder_ / "o.json").string());
    std::string wrong;
    size_t whole = 0;
    for (const char *name : outputs) {
        const State state = state_of(folder_ / name);
        whole += state == State::whole;
        if (state == State::damaged)
            wrong += fmt::format("{} is damaged; ", name);
        if (over_old_files_ && state == State::none)
            wrong += fmt::format("{} is lost; ", name);
    }
    const int code = outcome.exit_code;
    const bool all = whole == std::size(outputs), killed = fault == "KILL";
    const bool harmless = fault == "EINTR" || fault == "short" || fault == "none";
    const int by_signal = killed ? 137 : fault == "TERM" ? 143 : fault == "INT" ? 130 : 1;
    if (code != 0 && code != by_signal)
        wrong += fmt::format("exit code {}; ", code);
    if ((code == 0 && !all) || (code == 1 && all) || (code != 0 && harmless))
        wrong += fmt::format("exit code {}, and {} files are written; ", code, whole);
    if (!killed && holds_temporary_file(folder_.path()))
        wrong += "a temporary file is left; ";
    return wrong.empty() ? "" : fmt::format("{} at call {}: {}{}", fault, call, wrong, outcome.err);
}

} // namespace opal::test
