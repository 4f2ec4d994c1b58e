#include "sweep/record.h"

#include "base/error.h"
#include "image/image.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace opal {

// The keys of sweep.json are the members' names.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Replicate, seed, seconds, mse, rel_mse, mean_luminance)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Point, spp, replicates)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Shot, spp, seconds, rel_mse, file)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StrategyRecord, name, label, independent, compile_seconds, pilot_cost, pilot_seconds_a_sample, points, shot)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ReferenceRecord, made_by, spp, seconds, mean_luminance, stderr_luminance, variance_known)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SweepRecord, version, scene, scene_hash, device, driver, reference_file, width, height, lanes, command,
                                   integrator, replicates, spp, left_out_spp, budget, reference, strategies)

StrategyRecord &SweepRecord::strategy(const std::string &name, const std::string &label) {
    for (StrategyRecord &s : strategies)
        if (s.name == name)
            return s;
    StrategyRecord &added = strategies.emplace_back();
    added.name = name;
    added.label = label;
    return added;
}

SweepRecord resume(const std::filesystem::path &folder, const SweepRecord &fresh) {
    const std::filesystem::path file = folder / "sweep.json";
    std::ifstream stream(file);
    if (!stream)
        return fresh;
    SweepRecord kept;
    try {
        kept = nlohmann::json::parse(stream).get<SweepRecord>();
    } catch (const nlohmann::json::exception &error) {
        throw Error(fmt::format("{}: is no sweep that could be continued ({}); give another folder with -o", file.string(), error.what()));
    }
    const nlohmann::json was = kept, is = fresh;
    for (const char *key : {"version", "scene_hash", "integrator", "device", "driver", "lanes", "width", "height", "reference_file"})
        if (was[key] != is[key])
            throw Error(fmt::format("{}: holds another sweep ({} was {}, is {}); give another folder with -o", file.string(), key,
                                    was[key].dump(), is[key].dump()));
    kept.command = fresh.command;
    kept.replicates = fresh.replicates;
    kept.spp = fresh.spp;
    kept.budget = fresh.budget;
    kept.left_out_spp.clear();
    return kept;
}

void save(const SweepRecord &record, const std::filesystem::path &folder) {
    write_safely(folder / "sweep.json", nlohmann::json(record).dump(1) + "\n");
}

} // namespace opal
