// What all fuzz targets share: limits on time and memory, silence, and files in memory that readers open by name.
#pragma once

#include <filesystem>
#include <string_view>

namespace opal::fuzz {

// Each target defines it: gives one input to a reader. It catches the Errors that a user may see. libFuzzer reports
// any other exception, a failed assertion, and what the sanitizers find; the harness aborts where one call takes more
// than 1 GB, or more CPU time than 5 s per MB.
void try_input(std::string_view input);

// A file in memory with a name in the folder OPAL_FUZZ_FILES, where CMakeLists.txt lists the names.
class ServedFile {
public:
    explicit ServedFile(const char *name);
    void write(std::string_view bytes); // in place of what it held
    const std::filesystem::path &path() const { return path_; }

private:
    std::filesystem::path path_;
    int descriptor_;
};

// Aborts with the text unless `holds`. Oracles say with it what must be true of every result.
void require(bool holds, const char *text);

} // namespace opal::fuzz
