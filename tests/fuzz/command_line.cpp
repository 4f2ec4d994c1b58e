// The command line of every command: a word a line. It is parsed, and not run.
#include "base/error.h"
#include "commands/commands.h"
#include "commands/parse.h"
#include "fuzz/harness.h"
#include "fuzz/mutate.h"

#include <algorithm>

namespace opal::fuzz {

namespace {

// What the examples and rows of all commands hold.
struct Vocabulary {
    std::vector<std::string> examples, words;
};

void gather(const std::vector<Command> &commands, Vocabulary &vocabulary) {
    for (const Command &command : commands) {
        vocabulary.words.push_back(command.name);
        for (std::string example : command.examples) {
            std::ranges::replace(example, ' ', '\n');
            vocabulary.examples.push_back(example.substr(example.find('\n') + 1)); // without "opal"
        }
        for (const OptionRow &row : command.options) {
            for (const std::string &flag : flags_of(row))
                vocabulary.words.push_back(flag);
            if (const auto *names = std::get_if<OneOf<std::string>>(&row.check))
                vocabulary.words.insert(vocabulary.words.end(), names->values.begin(), names->values.end());
            if (const auto *accepts = std::get_if<Accepts>(&row.check))
                vocabulary.words.insert(vocabulary.words.end(), accepts->values.begin(), accepts->values.end());
        }
        gather(command.subcommands, vocabulary);
    }
}

const Vocabulary &vocabulary() {
    static const Vocabulary all = [] {
        Vocabulary gathered{{}, {"--", "-", "-h", "--help", "-V", "=", ",", "1,2", "a=b", "60s", "1h", "50%", "16k"}};
        gather(all_commands(), gathered);
        return gathered;
    }();
    return all;
}

// So that the next input may give the same names; other options are set anew.
void forget_definitions(const std::vector<Command> &commands) {
    for (const Command &command : commands) {
        for (const OptionRow &row : command.options)
            if (const auto *map = std::get_if<std::map<std::string, std::string> *>(&row.target))
                (*map)->clear();
        forget_definitions(command.subcommands);
    }
}

const TextFormat &format() {
    static const TextFormat lines = {.words = [](std::string_view text) { return separated(text, "\n="); },
                                     .replacements = vocabulary().words,
                                     .piece = '\n',
                                     .start = [](Random &random) { return one_of(vocabulary().examples, random); }};
    return lines;
}

} // namespace

void try_input(std::string_view input) {
    static const std::vector<Command> commands = all_commands();
    std::vector<std::string> words;
    for (size_t start = 0; start <= input.size();) {
        const size_t end = std::min(input.find('\n', start), input.size());
        words.emplace_back(input.substr(start, end - start));
        start = end + 1;
    }
    try {
        parse(commands, words);
    } catch (const UsageError &) {
    }
    forget_definitions(commands);
}

} // namespace opal::fuzz

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    return opal::fuzz::mutate(opal::fuzz::format(), data, size, max_size, seed);
}
