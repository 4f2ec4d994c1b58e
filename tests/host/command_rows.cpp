// Commands as data: what their rows say, and how the parser obeys rows.
#include "commands/commands.h"
#include "commands/help.h"
#include "commands/parse.h"
#include "commands/row_text.h"
#include "support/error_of.h"

#include <catch2/catch.hpp>

#include <iterator>
#include <set>
#include <sstream>

using namespace opal;

namespace {

// The address that an option writes to, and the key there.
std::pair<const void *, std::string> place_of(const OptionTarget &target) {
    if (const auto *entry = std::get_if<MapEntry>(&target))
        return {entry->map, entry->key};
    return std::visit(
        [](const auto &pointer) -> std::pair<const void *, std::string> {
            if constexpr (std::is_pointer_v<std::decay_t<decltype(pointer)>>)
                return {pointer, ""};
            else
                return {};
        },
        target);
}

// What is wrong with a command's rows; empty: nothing.
std::vector<std::string> problems_of(const Command &command) {
    std::vector<std::string> problems;
    std::set<std::string> flags;
    std::set<std::pair<const void *, std::string>> places;
    if (bool(command.run) == !command.subcommands.empty())
        problems.push_back(command.name + ": either runs or has subcommands");
    for (const OptionRow &row : command.options) {
        const std::string option = command.name + " " + row.flags + ": ";
        if (row.excludes && !flags.contains(row.excludes))
            problems.push_back(option + "excludes a flag that is not above it");
        std::istringstream names(row.flags);
        for (std::string name; std::getline(names, name, ',');)
            if (!flags.insert(name).second)
                problems.push_back(option + "is there twice");
        if (!places.insert(place_of(row.target)).second)
            problems.push_back(option + "sets what another option sets");
        if (row.help.empty() || row.help.back() == '\n')
            problems.push_back(option + "does not say what it means");
    }
    for (const Command &sub : command.subcommands)
        for (const std::string &problem : problems_of(sub))
            problems.push_back(command.name + " " + problem);
    return problems;
}

struct Values {
    bool flag = false;
    int number = 7;
    double seconds = 60;
    std::string word;
    std::filesystem::path file;
    std::map<std::string, std::string> map;
    std::optional<unsigned> side;
    std::vector<unsigned> list = {1, 2};
    std::vector<std::string> words;
};

std::vector<Command> commands_into(Values &v, int code = 0) {
    return {{.name = "go",
             .help = "Goes",
             .options = {{.flags = "FILE", .target = &v.file, .help = "a file", .type = "", .required = true},
                         {.flags = "--flag", .target = &v.flag, .help = "a flag"},
                         {.flags = "-n,--number", .target = &v.number, .help = "a number", .check = Range{1, 9}},
                         {.flags = "--budget", .target = &v.seconds, .help = "a time", .check = Duration{}},
                         {.flags = "--word",
                          .target = &v.word,
                          .help = "a word",
                          .check = OneOf<std::string>{{"red", "green"}},
                          .excludes = "--flag"},
                         {.flags = "--key", .target = MapEntry{&v.map, "key"}, .help = "an entry"},
                         {.flags = "--side", .target = &v.side, .help = "a side", .default_text = "64"},
                         {.flags = "--list", .target = &v.list, .help = "numbers", .comma_separated = true},
                         {.flags = "--words", .target = &v.words, .help = "words", .many_words = true}},
             .run = [code] { return code; }}};
}

std::string refusal_of(const std::vector<std::string> &words) {
    Values values;
    return opal::test::error_of([&] { parse(commands_into(values), words); });
}

} // namespace

TEST_CASE("Options have a name, a meaning and a variable of their own", "[command_rows]") {
    std::set<std::string> names;
    for (const Command &command : all_commands()) {
        CHECK(problems_of(command) == std::vector<std::string>{});
        CHECK((names.insert(command.name).second || (command.name + " is there twice").empty()));
    }
}

TEST_CASE("Wrong rows would be found", "[command_rows]") {
    std::string a, b;
    const Command wrong = {.name = "go",
                           .help = "Goes",
                           .options = {{.flags = "--a", .target = &a, .help = "one"},
                                       {.flags = "-x,--a", .target = &b, .help = "the flag is there twice"},
                                       {.flags = "--c", .target = &a, .help = "the variable is there twice"},
                                       {.flags = "--d", .target = MapEntry{nullptr, "d"}, .help = ""},
                                       {.flags = "--e",
                                        .target = MapEntry{nullptr, "e"},
                                        .help = "excludes what is not there",
                                        .excludes = "--f"}}};
    CHECK(problems_of(wrong) ==
          std::vector<std::string>{"go: either runs or has subcommands", "go -x,--a: is there twice",
                                   "go --c: sets what another option sets", "go --d: does not say what it means",
                                   "go --e: excludes a flag that is not above it"});
}

TEST_CASE("Options that are not given keep their targets", "[command_rows]") {
    Values v;
    CHECK(parse(commands_into(v, 3), {"go", "a.xml"})() == 3);
    CHECK(v.file == "a.xml");
    CHECK((!v.flag && v.number == 7 && v.seconds == 60 && v.word.empty() && v.map.empty() && !v.side));
    CHECK(v.list == std::vector<unsigned>{1, 2});
}

TEST_CASE("Options set their targets", "[command_rows]") {
    Values v;
    parse(commands_into(v), {"go", "--list", "4,16", "-n", "9", "--budget", "2min", "--word", "green", "--key", "value",
                             "--side", "5", "a b.xml", "--words", "one", "two"});
    CHECK(v.file == "a b.xml");
    CHECK((v.number == 9 && v.seconds == 120 && v.word == "green" && v.side == 5u));
    CHECK(v.list == std::vector<unsigned>{4, 16});
    CHECK(v.map == std::map<std::string, std::string>{{"key", "value"}});
    CHECK(v.words == std::vector<std::string>{"one", "two"});
}

TEST_CASE("Flags are written as usual", "[command_rows]") {
    Values v;
    parse(commands_into(v), {"go", "-n9", "--word=red", "--side=5", "--", "--a.xml"});
    CHECK((v.number == 9 && v.word == "red" && v.side == 5u && v.file == "--a.xml"));
    Values w;
    parse(commands_into(w), {"go", "--words", "one", "two", "--flag", "a.xml"});
    CHECK((w.words == std::vector<std::string>{"one", "two"} && w.flag && w.file == "a.xml"));
}

TEST_CASE("Help gives ranges and defaults that the parser has, and two examples that it takes", "[command_rows]") {
    Values values;
    const std::string help = help_of(commands_into(values)[0], "go");
    for (const char *part : {"Usage: opal go [OPTIONS] FILE", "-n, --number N", "a number (1 to 9) [7]", "[60]",
                             "--word red|green", "a side [64]", "numbers [1,2]"})
        CHECK_THAT(help, Catch::Contains(part));
    for_each_command(all_commands(), "", [](const Command &command, const std::string &path) {
        INFO(path);
        CHECK(command.examples.size() == 2);
        for (const std::string &example : command.examples) {
            std::istringstream stream(example.substr(0, example.find(" > ")));
            std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
            CHECK((words.size() > 1 && words[0] == "opal"));
            if (words[1].ends_with(".xml"))
                words.insert(words.begin() + 1, "render");
            CHECK(opal::test::error_of([&] { parse(all_commands(), {words.begin() + 1, words.end()}); }) == "");
        }
        for (const OptionRow &row : command.options)
            if (takes_value(row) && !is_positional(row)) {
                INFO(row.flags);
                CHECK(type_of(row) != "TEXT"); // says what is meant: FILE, NAME, ...
            }
    });
}

TEST_CASE("The options of the strategy are explained once", "[command_rows]") {
    const std::vector<Command> commands = all_commands();
    CHECK_THAT(strategies_help(commands), Catch::Contains("--emitter-choice") && Catch::Contains("balance: "));
    for (const Command &command : commands)
        CHECK_THAT(help_of(command, command.name), !Catch::Contains("balance: "));
}

TEST_CASE("Words that break a row are refused by the flag's name", "[command_rows]") {
    using Catch::Contains;
    CHECK_THAT(refusal_of({"go", "a.xml", "--number", "10"}),
               Contains("--number: 10 is out of range; possible: 1 to 9"));
    CHECK_THAT(refusal_of({"go", "a.xml", "--budget", "3days"}), Contains("--budget"));
    CHECK_THAT(refusal_of({"go", "a.xml", "--word", "blue"}),
               Contains("--word: unknown value 'blue'; available: red, green"));
    CHECK_THAT(refusal_of({"go", "a.xml", "--flag", "--word", "red"}),
               Contains("--word and --flag exclude each other"));
    CHECK_THAT(refusal_of({"go", "a.xml", "--side", "-1"}), Contains("--side"));
    CHECK_THAT(refusal_of({"go", "a.xml", "--side", "99999999999"}), Contains("out of range"));
    CHECK_THAT(refusal_of({"go", "a.xml", "--list", "4,x"}), Contains("--list: 'x' is no whole number"));
    CHECK_THAT(refusal_of({"go", "a.xml", "b.xml"}), Contains("'b.xml' is one argument too many"));
    CHECK_THAT(refusal_of({"go"}), Contains("opal go needs FILE"));
}
