#include "sweep/record.h"

#include "base/error.h"
#include "base/json.h"
#include "base/read_file.h"
#include "image/image.h"

#include <fmt/format.h>

namespace opal {

// The keys of sweep.json are the members' names.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Replicate, seed, seconds, mse, rel_mse, mean_luminance, invalid)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SweepPoint, spp, replicates)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EqualTimeImage, spp, seconds, rel_mse, file)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DeviceRecord, index, name, driver)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StrategyRecord, name, label, device, lanes, independent, compile_seconds, pilot_cost,
                                   pilot_seconds_a_sample, points, shot)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ReferenceRecord, made_by, spp, seconds, mean_luminance, stderr_luminance,
                                   variance_known, mean_square)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SweepRecord, version, scene, scene_hash, dialect, definitions, reference_file, clock,
                                   devices, width, height, crop, kernel, command, integrator, replicates, spp,
                                   left_out_spp, budget, reference, strategies)

StrategyRecord &SweepRecord::strategy(const std::string &name, const std::string &label) {
    for (StrategyRecord &s : strategies)
        if (s.name == name)
            return s;
    StrategyRecord &added = strategies.emplace_back();
    added.name = name;
    added.label = label;
    return added;
}

SweepRecord load_record(const std::filesystem::path &folder) {
    const std::filesystem::path file = folder / "sweep.json";
    try {
        return parse_json(read_file(file)).get<SweepRecord>();
    } catch (const nlohmann::json::exception &error) {
        throw Error(fmt::format("{}: is no sweep that could be continued ({}); give another folder with -o",
                                file.string(), error.what()));
    }
}

SweepRecord resume(const std::filesystem::path &folder, const SweepRecord &fresh) {
    const std::filesystem::path file = folder / "sweep.json";
    if (!std::filesystem::exists(file))
        return fresh;
    SweepRecord kept = load_record(folder);
    const nlohmann::json was = kept, is = parse_json(dump(fresh)); // as load_record would return it
    for (const char *key : {"version", "scene_hash", "dialect", "definitions", "integrator", "devices", "clock",
                            "width", "height", "crop", "reference_file"})
        if (was[key] != is[key])
            throw Error(fmt::format("{}: holds another sweep ({} was {}, is {}); give another folder with -o",
                                    file.string(), key, dump(was[key]), dump(is[key])));
    kept.command = fresh.command;
    kept.replicates = fresh.replicates;
    kept.spp = fresh.spp;
    kept.budget = fresh.budget;
    kept.left_out_spp.clear();
    return kept;
}

void save(const SweepRecord &record, const std::filesystem::path &folder) { save(record, folder, nullptr); }

void save(const SweepRecord &record, const std::filesystem::path &folder, const nlohmann::json &summary) {
    nlohmann::json j = record;
    if (!summary.is_null())
        j["summary"] = summary;
    write_safely(folder / "sweep.json", dump(j, 1) + "\n");
}

} // namespace opal
