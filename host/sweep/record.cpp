#include "sweep/record.h"

#include "base/error.h"
#include "base/json.h"
#include "base/read_file.h"
#include "image/image.h"
#include "sweep/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <set>
#include <utility>

namespace opal {

// The keys of sweep.json are the members' names.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Replicate, seed, seconds, mse, rel_mse, mean_luminance, invalid)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SweepPoint, spp, replicates)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EqualTimeImage, spp, seconds, rel_mse, file)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DeviceRecord, index, name, driver)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StrategyRecord, name, label, device, lanes, independent, compile_seconds, pilot_cost,
                                   pilot_seconds_a_sample, points, shot)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ReferenceRecord, made_by, spp, seconds, mean_luminance, stderr_luminance,
                                   variance_known, mean_square, hash)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SweepRecord, version, scene, scene_hash, kernels_hash, dialect, definitions, options,
                                   seed, reference_file, reference_hash, reference_spp, clock, devices, width, height,
                                   crop, kernel, command, integrator, replicates, spp, left_out_spp, budget, reference,
                                   strategies)

StrategyRecord &SweepRecord::strategy(const std::string &name, const std::string &label) {
    for (StrategyRecord &s : strategies)
        if (s.name == name)
            return s;
    StrategyRecord &added = strategies.emplace_back();
    added.name = name;
    added.label = label;
    return added;
}

namespace {

using nlohmann::json;

// Throws Error unless each key of `like` is in `value`, with a value of its type that the record's number can hold.
void check_types(const json &value, const json &like, const std::string &key) {
    const auto must = [&](bool good, const std::string &what) {
        if (!good)
            throw Error(fmt::format("{} is no {}", key, what));
    };
    switch (like.type()) {
    case json::value_t::object:
        must(value.is_object(), "object");
        for (const auto &[name, inner] : value.items())
            must(!like.empty() || inner.is_string(), "object of texts");
        for (const auto &[name, inner] : like.items()) {
            const std::string place = key.empty() ? name : key + "." + name;
            if (!value.contains(name))
                throw Error(place + " is missing");
            check_types(value[name], inner, place);
        }
        break;
    case json::value_t::array:
        must(value.is_array(), "list");
        for (size_t i = 0; i < value.size(); i++)
            check_types(value[i], like[0], fmt::format("{}[{}]", key, i));
        break;
    case json::value_t::number_unsigned:
        must(value.is_number_unsigned() && std::in_range<unsigned>(value.get<std::uint64_t>()),
             "whole number from 0 to 4294967295");
        break;
    case json::value_t::number_integer:
        must(value.is_number_integer() &&
                 (!value.is_number_unsigned() || std::in_range<int>(value.get<std::uint64_t>())) &&
                 std::in_range<int>(value.get<std::int64_t>()),
             "whole number");
        break;
    case json::value_t::number_float:
        must(value.is_number(), "number");
        break;
    case json::value_t::boolean:
        must(value.is_boolean(), "true or false");
        break;
    default:
        must(value.is_string(), "text");
    }
}

// A record with one entry in each list, for check_types.
json typical_record() {
    SweepRecord record;
    record.devices.resize(1);
    record.spp = record.left_out_spp = {1};
    record.strategies.resize(1);
    record.strategies[0].points = {{1, {{}}}};
    return record;
}

// Throws Error unless the record is one that a sweep writes: what reads it may rely on that.
void check(const SweepRecord &r) {
    const auto must = [](bool good, const std::string &key, const std::string &what) {
        if (!good)
            throw Error(key + " is " + what);
    };
    const auto rising = [&](const std::vector<unsigned> &spp, const std::string &key) {
        must(std::ranges::adjacent_find(spp, std::greater_equal()) == spp.end() &&
                 std::ranges::all_of(spp, [](unsigned n) { return n >= 1 && n <= first_pilot_sample; }),
             key, "no rising list of samples per pixel");
    };
    must(!r.devices.empty(), "devices", "empty");
    must(r.width >= 1, "width", "below 1");
    must(r.height >= 1, "height", "below 1");
    must(r.clock == "kernel" || r.clock == "cpu", "clock", "neither kernel nor cpu");
    must(r.kernel == "general" || r.kernel == "special", "kernel", "neither general nor special");
    must(!r.spp.empty(), "spp", "empty");
    rising(r.spp, "spp");
    rising(r.left_out_spp, "left_out_spp");
    must(r.budget >= 0, "budget", "below 0");
    must(r.reference.seconds >= 0, "reference.seconds", "below 0");
    must(r.reference.stderr_luminance >= 0, "reference.stderr_luminance", "below 0");
    must(r.reference.mean_square >= 0, "reference.mean_square", "below 0");
    std::set<std::string> names;
    for (size_t i = 0; i < r.strategies.size(); i++) {
        const StrategyRecord &s = r.strategies[i];
        const std::string key = fmt::format("strategies[{}]", i), picture = fmt::format("equal_time_{}", i + 1);
        must(!s.name.empty(), key + ".name", "empty");
        must(names.insert(s.name).second, key + ".name", "that of another strategy");
        must(s.device < r.devices.size(), key + ".device", "none of the devices");
        must(s.lanes >= 0, key + ".lanes", "below 0");
        must(s.compile_seconds >= 0, key + ".compile_seconds", "below 0");
        must(s.pilot_cost >= 0, key + ".pilot_cost", "below 0");
        must(s.pilot_seconds_a_sample >= 0, key + ".pilot_seconds_a_sample", "below 0");
        std::vector<unsigned> spp;
        for (size_t p = 0; p < s.points.size(); p++) {
            const std::string point = fmt::format("{}.points[{}]", key, p);
            spp.push_back(s.points[p].spp);
            for (size_t n = 0; n < s.points[p].replicates.size(); n++) {
                const Replicate &replicate = s.points[p].replicates[n];
                const std::string own = fmt::format("{}.replicates[{}]", point, n);
                must(replicate.seed == r.seed + 1 + unsigned(n), own + ".seed",
                     fmt::format("{}, not {}", replicate.seed, r.seed + 1 + unsigned(n)));
                must(replicate.seconds >= 0, own + ".seconds", "below 0");
            }
        }
        rising(spp, key + ".points");
        must(s.shot.file.empty() || s.shot.file == picture, key + ".shot.file", "not " + picture);
        must(s.shot.spp <= first_pilot_sample, key + ".shot.spp", "too large");
        must(s.shot.seconds >= 0, key + ".shot.seconds", "below 0");
    }
}

} // namespace

SweepRecord load_record(const std::filesystem::path &folder) {
    const std::filesystem::path file = folder / "sweep.json";
    const std::string text = read_file(file);
    try {
        const json j = parse_json(text);
        check_types(j, typical_record(), "");
        SweepRecord record = j.get<SweepRecord>();
        for (StrategyRecord &s : record.strategies)
            std::erase_if(s.points, [](const SweepPoint &point) { return point.replicates.empty(); });
        check(record);
        return record;
    } catch (const std::exception &error) { // of the library's parser, or as above
        throw Error(fmt::format("{}: is no sweep that could be continued: {}; give another folder with -o",
                                file.string(), error.what()));
    }
}

SweepRecord resume(const std::filesystem::path &folder, const SweepRecord &fresh) {
    const std::filesystem::path file = folder / "sweep.json";
    if (!std::filesystem::exists(file))
        return fresh;
    SweepRecord kept = load_record(folder);
    const json was = kept, is = parse_json(dump(fresh)); // as load_record would return it
    for (const std::string key :
         {"version", "scene_hash", "kernels_hash", "dialect", "definitions", "integrator", "options", "seed", "devices",
          "clock", "width", "height", "crop", "reference_file", "reference_hash", "reference_spp"}) {
        if (was[key] == is[key])
            continue;
        std::string place = key;
        json before = was[key], now = is[key];
        if (now.is_object()) // names the first value that differs
            for (const json &all : {was[key], is[key]})
                for (const auto &[name, value] : all.items())
                    if (place == key &&
                        (!was[key].contains(name) || !is[key].contains(name) || was[key][name] != is[key][name])) {
                        place += "." + name;
                        before = was[key].value(name, json());
                        now = is[key].value(name, json());
                    }
        throw Error(fmt::format("{}: holds another sweep ({} was {}, is {}); give another folder with -o",
                                file.string(), place, dump(before), dump(now)));
    }
    kept.command = fresh.command;
    kept.replicates = fresh.replicates;
    kept.spp = fresh.spp;
    kept.budget = fresh.budget;
    kept.left_out_spp.clear();
    return kept;
}

bool is_whole_picture(const std::filesystem::path &file) {
    if (!std::filesystem::exists(file))
        return false;
    if (file.extension() == ".png") {
        const std::string bytes = read_file(file);
        return bytes.starts_with("\x89PNG") && bytes.ends_with("IEND\xae\x42\x60\x82");
    }
    try {
        return read_exr(file).width > 0;
    } catch (const Error &) { // cut off, or no EXR
        return false;
    }
}

void save(const SweepRecord &record, const std::filesystem::path &folder) { save(record, folder, nullptr); }

void save(const SweepRecord &record, const std::filesystem::path &folder, const nlohmann::json &summary) {
    nlohmann::json j = record;
    if (!summary.is_null())
        j["summary"] = summary;
    write_safely(folder / "sweep.json", dump(j, 1) + "\n");
}

} // namespace opal
