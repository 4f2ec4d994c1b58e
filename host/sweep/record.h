// What a sweep has measured: kept in sweep.json, from which a later run goes on.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace opal {

// One render of one strategy with one seed.
struct Replicate {
    unsigned seed = 0;
    double seconds = 0;          // by the record's clock
    double mse = 0, rel_mse = 0; // against the reference, its variance subtracted; may then come out below 0
    double mean_luminance = 0;
    unsigned long long invalid = 0; // samples, NaN or infinite, left out
};

struct Point {
    unsigned spp = 0;
    std::vector<Replicate> replicates;
};

struct Shot { // the picture at equal time
    unsigned spp = 0;
    double seconds = 0, rel_mse = 0;
    std::string file; // without ending: FILE.exr, FILE.png, FILE_error.png lie in the folder
};

struct DeviceRecord {
    int index = 0; // of `opal devices`
    std::string name, driver;
};

struct StrategyRecord {
    std::string name, label;
    size_t device = 0; // place in the record's list
    int lanes = 0;
    bool independent = true; // samples: MSE falls as 1/spp
    double compile_seconds = 0;
    double pilot_cost = 0, pilot_seconds_a_sample = 0; // variance of a pixel's sample, times its seconds, averaged
    std::vector<Point> points;
    Shot shot;
};

struct ReferenceRecord {
    std::string made_by; // a strategy's name, or the file
    unsigned spp = 0;    // 0: a file's, unknown
    double seconds = 0;
    double mean_luminance = 0, stderr_luminance = 0;
    bool variance_known = false;
    double mean_square = 0; // over pixels and R, G, B: what an MSE is measured by
};

struct SweepRecord {
    // What may not change between runs into one folder.
    std::string version, scene, scene_hash, reference_file, clock; // kernel or cpu
    std::vector<DeviceRecord> devices;
    int width = 0, height = 0;
    // What may.
    std::string command, integrator;
    unsigned replicates = 0;
    std::vector<unsigned> spp, left_out_spp; // left out for the budget
    double budget = 0;
    ReferenceRecord reference;
    std::vector<StrategyRecord> strategies;

    StrategyRecord &strategy(const std::string &name, const std::string &label); // added where it is not there
};

SweepRecord load_record(const std::filesystem::path &folder);
// The record in the folder, or `fresh` where there is none. Error naming what differs where the folder holds another
// sweep.
SweepRecord resume(const std::filesystem::path &folder, const SweepRecord &fresh);
// sweep.json, written safely; with the summary of a finished sweep, which a later run does not read.
void save(const SweepRecord &record, const std::filesystem::path &folder);
void save(const SweepRecord &record, const std::filesystem::path &folder, const nlohmann::json &summary);

} // namespace opal
