#include "base/log.h"

#include "base/error.h"
#include "base/printable.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <new>

#include <fcntl.h>

namespace opal {

namespace {

bool quiet_chosen = false, verbose_chosen = false;
std::vector<std::string> kept_warnings;
int first_output_error = 0;

std::mutex streams;      // bars are told by threads of their own
bool bar_stands = false; // on stderr, without a line end

// `streams` must be locked.
void clear_bar() {
    if (bar_stands)
        std::fputs(clear_line, stderr);
    bar_stands = false;
}

std::FILE *results = stdout;

void write(const std::string &text, std::FILE *stream) {
    const std::lock_guard lock(streams);
    clear_bar();
    errno = 0;
    const bool taken = std::fwrite(text.data(), 1, text.size(), stream) == text.size() && std::fflush(stream) == 0;
    if (!taken && stream == stdout && first_output_error == 0)
        first_output_error = errno ? errno : EIO;
}

// All messages pass here: none steers the terminal.
void say(const char *prefix, const std::string &text) {
    const std::string shown = printable(text);
    const std::lock_guard lock(streams);
    clear_bar();
    std::fprintf(stderr, "%s%s\n", prefix, shown.c_str());
}

// A message about files, scenes and values.
std::string sentence(const std::string &text) { return in_one_line(shortened_message(text)); }

} // namespace

void set_quiet(bool quiet) { quiet_chosen = quiet; }
bool is_quiet() { return quiet_chosen; }

void info(const std::string &line) {
    if (!quiet_chosen)
        say("", shortened_message(line));
}

void set_verbose(bool verbose) { verbose_chosen = verbose; }

void detail(const std::string &text) {
    if (verbose_chosen)
        say("", text);
}

void note(const std::string &line) {
    if (!quiet_chosen)
        say("note: ", sentence(line));
}

void warn(const std::string &line) {
    constexpr size_t most_warnings = 1000; // a file may ask for a million; each stands in the reports, too
    if (kept_warnings.size() > most_warnings)
        return;
    kept_warnings.push_back(kept_warnings.size() < most_warnings ? shortened_message(line)
                                                                 : "more warnings follow, which are not told");
    say("warning: ", sentence(kept_warnings.back()));
}

const std::vector<std::string> &warnings() { return kept_warnings; }
void forget_warnings() { kept_warnings.clear(); }

void tell_error(const char *line) { say("error: ", sentence(line)); }

void tell_error(const std::exception &error) {
    if (const auto *list = dynamic_cast<const ErrorList *>(&error))
        for (const std::string &line : list->lines())
            tell_error(line.c_str());
    else if (dynamic_cast<const std::bad_alloc *>(&error))
        tell_error("out of memory on the host");
    else
        tell_error(error.what());
}

void show(const std::string &text) {
    const std::lock_guard lock(streams);
    std::fputs(text.c_str(), stderr);
    bar_stands = !text.ends_with(clear_line) && !text.ends_with('\n');
}

void free_stdout() { results = stderr; }

void print_data(const std::string &text) { write(text, stdout); }

void print_text(const std::string &text) { write(printable(text), results); }

int output_error() { return first_output_error; }

void prepare_streams() {
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    // stdin and stdout are opened the wrong way round, so that using them still fails; /dev/full fails through
    // /dev/stdout, too.
    struct Stream {
        const char *file;
        int mode;
    };
    constexpr Stream closed[] = {{"/dev/null", O_WRONLY}, {"/dev/full", O_RDONLY}, {"/dev/null", O_WRONLY}};
    for (int descriptor = 0; descriptor < 3; descriptor++)
        if (fcntl(descriptor, F_GETFD) < 0 && errno == EBADF)
            (void)!open(closed[descriptor].file, closed[descriptor].mode); // gets the lowest number that is free
}

} // namespace opal
