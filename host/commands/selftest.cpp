// opal selftest: is what this device computes right? Each group of checks runs in a process of its own.
#include "selftest/selftest.h"
#include "base/log.h"
#include "base/process.h"
#include "base/table.h"
#include "commands/commands.h"
#include "commands/options.h"
#include "device/ask_driver.h"
#include "device/info_json.h"
#include "image/image.h"

#include <fmt/format.h>

#include <deque>
#include <sstream>

namespace opal {

namespace {

const std::string line_mark = "opal-finding "; // drivers print to stdout too

struct Options {
    std::string device, json, cl_dir;
    std::vector<std::string> groups; // none: all
    bool full = false, quick = false;
    double time_limit = 0;
    unsigned seed = 0;
};

// A group at one width and one kind of math.
struct Job {
    const CheckGroup *group;
    size_t variant;
    Findings findings;
    std::string problem;
};

struct Variant {
    int lanes;
    std::string math;
    std::string name() const { return fmt::format("{} {}", lanes, math); }
};

std::vector<Variant> variants_of(const DeviceInfo &device) {
    std::vector<Variant> variants = {{1, "precise"}, {1, "fast"}};
    if (device.native_lanes != 1)
        variants.insert(variants.end(), {{device.native_lanes, "precise"}, {device.native_lanes, "fast"}});
    return variants;
}

ChildProcess start(const Job &job, const Variant &variant, const DeviceInfo &device, const Options &o) {
    const nlohmann::json json = device;
    return ChildProcess(own_binary(), {"selftest-group", job.group->name, dump(json, -1), std::to_string(variant.lanes),
                                       variant.math, o.full ? "full" : "quick", std::to_string(o.seed), o.cl_dir});
}

void finish(Job &job, ChildProcess &process, ChildProcess::Clock::time_point deadline, double time_limit) {
    const Ending ending = process.finish(deadline);
    std::istringstream lines(process.said());
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with(line_mark)) {
            const nlohmann::json json = nlohmann::json::parse(line.substr(line_mark.size()));
            if (json.contains("problem"))
                job.problem = json["problem"];
            else
                job.findings.push_back({json["check"], json["figure"].is_number() ? json["figure"].get<double>() : NAN,
                                        json["limit"], json["passed"]});
        }
    if (!ending.in_time)
        job.problem = fmt::format("did not end within {:g} s", time_limit);
    else if (ending.signal)
        job.problem = fmt::format("crashed ({})", ending.signal_name());
    else if (job.problem.empty() && (ending.exit_code || job.findings.empty()))
        job.problem = fmt::format("ended with exit code {}", ending.exit_code);
}

// Two processes at a time: a driver compiles on one core while another computes.
void run_jobs(std::vector<Job> &jobs, const std::vector<Variant> &variants, const DeviceInfo &device,
              const Options &o) {
    using Clock = ChildProcess::Clock;
    struct Running {
        Job *job;
        ChildProcess process;
        Clock::time_point deadline;
    };
    const double limit = o.time_limit > 0 ? o.time_limit : o.full ? 1200 : 120;
    std::deque<Running> running;
    const auto finish_first = [&] {
        finish(*running.front().job, running.front().process, running.front().deadline, limit);
        running.pop_front();
    };
    for (Job &job : jobs) {
        if (running.size() == 2)
            finish_first();
        running.push_back(
            {&job, start(job, variants[job.variant], device, o),
             Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limit))});
    }
    while (!running.empty())
        finish_first();
}

const Finding *find_check(const std::vector<Job> &jobs, size_t variant, const std::string &check) {
    for (const Job &job : jobs)
        if (job.variant == variant)
            for (const Finding &finding : job.findings)
                if (finding.check == check)
                    return &finding;
    return nullptr;
}

// A line a check, a column a variant; "!" marks what failed.
void print_table(const std::vector<Job> &jobs, const std::vector<Variant> &variants) {
    print("{:<52}{:>10}", "check", "limit");
    for (const Variant &variant : variants)
        print("{:>13}", variant.name());
    print("\n");
    std::vector<std::string> done;
    for (const Job &from : jobs)
        for (const Finding &row : from.findings) {
            if (std::find(done.begin(), done.end(), row.check) != done.end())
                continue;
            done.push_back(row.check);
            std::string line, limit = fmt::format("{:.3g}", row.limit);
            for (size_t v = 0; v < variants.size(); v++) {
                const Finding *finding = find_check(jobs, v, row.check);
                line += fmt::format("{:>12}{}", finding ? fmt::format("{:.3g}", finding->figure) : "-",
                                    finding && !finding->passed ? "!" : " ");
            }
            print("{:<52}{:>10}{}\n", row.check, limit, line);
        }
    for (const Job &job : jobs)
        if (!job.problem.empty())
            print("{} at {}: {}\n", job.group->name, variants[job.variant].name(), job.problem);
}

int run(const Options &o) {
    if (o.full && o.quick)
        throw Error("--quick and --full exclude each other");
    for (const std::string &group : o.groups)
        find_row(check_groups(), "group", group);
    if (!o.json.empty())
        check_writable(o.json);
    const DevicePick pick = pick_device(o.device, list_devices());
    info(fmt::format("device  {} (driver {}; {})", pick.info.name, pick.info.driver, pick.reason));
    const std::vector<Variant> variants = variants_of(pick.info);
    std::vector<Job> jobs;
    for (const CheckGroup &group : check_groups())
        if (o.groups.empty() || std::find(o.groups.begin(), o.groups.end(), group.name) != o.groups.end())
            for (size_t v = 0; v < variants.size(); v++)
                jobs.push_back({&group, v, {}, {}});
    const auto begun = ChildProcess::Clock::now();
    run_jobs(jobs, variants, pick.info, o);
    print_table(jobs, variants);

    size_t checks = 0, failed = 0, problems = 0;
    nlohmann::json report = {{"device", pick.info}, {"checks", nlohmann::json::array()}};
    for (const Job &job : jobs) {
        problems += !job.problem.empty();
        for (const Finding &f : job.findings) {
            checks++;
            failed += !f.passed;
            report["checks"].push_back({{"check", f.check},
                                        {"lanes", variants[job.variant].lanes},
                                        {"math", variants[job.variant].math},
                                        {"figure", f.figure},
                                        {"limit", f.limit},
                                        {"passed", f.passed}});
        }
        if (!job.problem.empty())
            report["checks"].push_back({{"check", job.group->name},
                                        {"lanes", variants[job.variant].lanes},
                                        {"math", variants[job.variant].math},
                                        {"passed", false},
                                        {"problem", job.problem}});
    }
    print("{}: {} of {} checks passed{}, {:.0f} s\n", failed + problems ? "FAILED" : "passed", checks - failed, checks,
          problems ? fmt::format(", {} groups did not end well", problems) : "",
          std::chrono::duration<double>(ChildProcess::Clock::now() - begun).count());
    if (!o.json.empty())
        write_safely(o.json, dump(report, 2) + "\n");
    return failed + problems ? 1 : 0;
}

// The other side: runs one group and prints its findings.
int run_group(const std::vector<std::string> &words) {
    if (words.size() < 6)
        throw Error("selftest-group is started by opal selftest");
    const CheckGroup &group = find_row(check_groups(), "group", words[0]);
    try {
        const Device device = open_device(nlohmann::json::parse(words[1]).get<DeviceInfo>());
        const Sources sources =
            words.size() < 7 || words[6].empty() ? Sources::embedded() : Sources::from_folder(words[6]);
        SelftestOptions options;
        options.build.lanes = std::stoi(words[2]);
        options.build.math = words[3] == "fast" ? MathMode::fast : MathMode::precise;
        options.full = words[4] == "full";
        options.seed = unsigned(std::stoul(words[5]));
        options.sources = &sources;
        for (const Finding &f : group.run(device, options))
            print("{}{}\n", line_mark,
                  dump({{"check", f.check}, {"figure", f.figure}, {"limit", f.limit}, {"passed", f.passed}}));
    } catch (const std::exception &error) {
        print("{}{}\n", line_mark, dump({{"problem", error.what()}}));
    }
    return 0;
}

} // namespace

RunCommand setup_selftest(CLI::App &app) {
    auto o = std::make_shared<Options>();
    add_device_option(app, o->device);
    app.add_flag("--quick", o->quick, "Less than a minute (default)");
    app.add_flag("--full", o->full, "More cases, more samples: minutes");
    std::string groups;
    for (const CheckGroup &group : check_groups())
        groups += fmt::format("\n  {}: {}", group.name, group.help);
    app.add_option("--group", o->groups, "Only this group of checks; may be repeated" + groups)->type_name("NAME");
    app.add_option("--time-limit", o->time_limit, "Seconds for each group of checks [120, or 1200 with --full]")
        ->check(CLI::PositiveNumber);
    app.add_option("--seed", o->seed, "Of the random numbers")->capture_default_str();
    app.add_option("--json", o->json, "File for the findings");
    app.add_option("--cl-dir", o->cl_dir, "Read the kernels from this copy of cl/")->type_name("FOLDER");
    return [o] { return run(*o); };
}

RunCommand setup_selftest_group(CLI::App &app) {
    auto words = std::make_shared<std::vector<std::string>>();
    app.add_option("words", *words, "GROUP DEVICE LANES MATH EFFORT SEED [FOLDER]");
    return [words] { return run_group(*words); };
}

} // namespace opal
