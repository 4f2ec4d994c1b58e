#include "support/mutants.h"

#include "base/error.h"
#include "support/device.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

namespace opal::test {

Sources mutated(const Sources &sources, const Mutant &mutant) {
    Sources changed = sources;
    const auto file = changed.files.find(mutant.file);
    if (file == changed.files.end())
        throw Error(fmt::format("mutant \"{}\": there is no file cl/{}", mutant.name, mutant.file));
    std::string &text = file->second;
    const size_t place = text.find(mutant.from);
    if (place == std::string::npos)
        throw Error(fmt::format("mutant \"{}\": cl/{} has no text \"{}\"", mutant.name, mutant.file, mutant.from));
    if (text.find(mutant.from, place + 1) != std::string::npos)
        throw Error(fmt::format("mutant \"{}\": cl/{} has the text \"{}\" more than once", mutant.name, mutant.file,
                                mutant.from));
    text.replace(place, mutant.from.size(), mutant.to);
    return changed;
}

std::string write_kernels(const ScratchFolder &folder, const Sources &sources) {
    for (const auto &[name, text] : sources.files)
        folder.write("cl/" + name, text);
    return (folder / "cl").string();
}

std::string write_kernels(const ScratchFolder &folder, const Mutant &mutant) {
    return write_kernels(folder, mutated(Sources::embedded(), mutant));
}

void require_all_killed(const std::vector<Control> &controls, unsigned seed) {
    size_t killed = 0, run = 0;
    for (const Control &control : controls) {
        if (control.mutant.many_lanes && tested_lanes() == std::vector<int>{1}) {
            fmt::print("left out, as this device carries one lane: {} (cl/{})\n", control.mutant.name,
                       control.mutant.file);
            continue;
        }
        run++;
        const Sources sources = mutated(Sources::embedded(), control.mutant);
        const Findings findings = control.check(sources, seed);
        const bool dead = rejected(findings);
        killed += dead;
        fmt::print("{} by {:<14} {} (cl/{}): {}\n", dead ? "killed  " : "SURVIVED", control.check_name,
                   control.mutant.name, control.mutant.file, text_of(worst(findings)));
        std::fflush(stdout);
        CHECK(dead);
    }
    fmt::print("{} of {} mutants killed\n", killed, run);
    CHECK(killed == run);
}

} // namespace opal::test
