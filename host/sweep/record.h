// The record of a sweep: all its measurements, kept in sweep.json, so that a later run continues it.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace opal {

// One render of one strategy with one seed.
struct Replicate {
    unsigned seed = 0;
    double seconds = 0;          // by the record's clock
    double mse = 0, rel_mse = 0; // unbiased estimates against the reference, possibly negative
    double mean_luminance = 0;
    unsigned long long invalid = 0; // number of samples left out as NaN or infinite
};

// All replicates of one strategy at one number of samples per pixel.
struct SweepPoint {
    unsigned spp = 0;
    std::vector<Replicate> replicates;
};

// A strategy's image at the render time that all strategies get.
struct EqualTimeImage {
    unsigned spp = 0;
    double seconds = 0, rel_mse = 0;
    std::string file; // stem of FILE.exr, FILE.png and FILE_error.png in the folder
};

struct DeviceRecord {
    int index = 0; // in `opal devices`
    std::string name, driver;
};

struct StrategyRecord {
    std::string name, label;
    size_t device = 0; // index in SweepRecord::devices
    int lanes = 0;
    bool independent = true; // the samples are, so that MSE falls as 1/spp
    double compile_seconds = 0;
    double pilot_cost = 0, pilot_seconds_a_sample = 0; // as in pilot_costs and Pilot
    std::vector<SweepPoint> points;
    EqualTimeImage shot;
};

struct ReferenceRecord {
    std::string made_by; // a strategy's name, or the file that was given
    unsigned spp = 0;    // 0: unknown, for a given file
    double seconds = 0;
    double mean_luminance = 0, stderr_luminance = 0;
    bool variance_known = false;
    double mean_square = 0; // over pixels and R, G, B, the scale of an MSE
    std::string hash{};     // FileHashes of reference.exr; empty for a given file
};

struct SweepRecord {
    // A run that continues a sweep must agree in these.
    std::string version, scene, scene_hash, dialect, reference_file, clock; // clock: kernel or cpu
    std::string kernels_hash, reference_hash;                               // of the kernels' sources, of the file
    std::map<std::string, std::string> definitions;                         // of the scene
    std::map<std::string, std::string> options; // of the scene's strategy, by their names on the command line
    unsigned seed = 0;                          // replicate r of each point, from 0 on, has seed + 1 + r
    unsigned reference_spp = 0;                 // that was asked for; 0: the default
    std::vector<DeviceRecord> devices;
    int width = 0, height = 0; // of the whole image
    std::string crop;          // the part that is rendered, in words; empty: all
    // In these it may differ.
    // The kernels of all strategies whose names say nothing else: general or special. A sweep that is continued goes on
    // with the kernels that it began with.
    std::string kernel;
    std::string command, integrator;
    unsigned replicates = 0;
    std::vector<unsigned> spp, left_out_spp; // measured, and left out for the budget; ascending
    double budget = 0;                       // seconds; 0: none
    ReferenceRecord reference;
    std::vector<StrategyRecord> strategies;

    StrategyRecord &strategy(const std::string &name, const std::string &label); // appended if it is new
};

// Reads sweep.json in the folder and checks it. Throws Error with the key and what is wrong if it is no record that
// could be continued. Points without replicates are left out.
SweepRecord load_record(const std::filesystem::path &folder);
// The record in the folder with the options of `fresh`, or `fresh` if there is none. Throws Error with the difference
// if the folder holds another sweep.
SweepRecord resume(const std::filesystem::path &folder, const SweepRecord &fresh);
// Whether a PNG or EXR is there and has its end. Throws Error if it is there and cannot be read.
bool is_whole_picture(const std::filesystem::path &file);
// Writes sweep.json safely. A finished sweep adds its summary, which a later run does not read.
void save(const SweepRecord &record, const std::filesystem::path &folder);
void save(const SweepRecord &record, const std::filesystem::path &folder, const nlohmann::json &summary);

} // namespace opal
