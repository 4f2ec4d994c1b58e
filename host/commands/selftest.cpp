// opal selftest: does this device compute right? Each group of checks runs in a process of its own.
#include "selftest/selftest.h"
#include "base/exit_code.h"
#include "base/json.h"
#include "base/log.h"
#include "base/process.h"
#include "base/progress.h"
#include "base/table.h"
#include "commands/commands.h"
#include "commands/json_file.h"
#include "commands/options.h"
#include "device/ask_driver.h"
#include "device/info_json.h"
#include "image/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <set>
#include <sstream>

namespace opal {

namespace {

struct Options {
    DeviceOptions device;
    std::string json, cl_dir;
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
    try {
        for (std::string line; std::getline(lines, line);) {
            const nlohmann::json json = parse_json(line);
            if (json.contains("problem"))
                job.problem = json["problem"];
            else
                job.findings.push_back({json["check"], json["figure"].is_number() ? json["figure"].get<double>() : NAN,
                                        json["limit"], json["passed"], json["subject"]});
        }
    } catch (const nlohmann::json::exception &) { // the last line of a process that crashed may be cut
        job.problem = "gave findings that cannot be read";
    }
    if (ending.too_long)
        job.problem = "gave too many findings to be read";
    else if (!ending.in_time)
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
    RunningProgress progress("selftest");
    size_t done = 0;
    const auto finish_first = [&] {
        finish(*running.front().job, running.front().process, running.front().deadline, limit);
        running.pop_front();
        progress.update(double(++done), double(jobs.size()));
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

struct SelftestReport {
    const DeviceInfo &device;
    const std::vector<Variant> &variants;
    const std::vector<Job> &jobs;
    double seconds;

    bool passed() const { return count_failed() + count_problems() == 0; }
    std::string text() const; // a line a check, a column a variant; "!" marks what failed
    nlohmann::json json() const;

private:
    size_t count_checks() const;
    size_t count_failed() const;
    size_t count_problems() const; // jobs that crashed, hung or failed
    const Finding *find_check(size_t variant, const std::string &check) const;
    std::string row(const Finding &check) const;
};

size_t SelftestReport::count_checks() const {
    size_t count = 0;
    for (const Job &job : jobs)
        count += job.findings.size();
    return count;
}

size_t SelftestReport::count_failed() const {
    size_t count = 0;
    for (const Job &job : jobs)
        count += size_t(std::ranges::count(job.findings, false, &Finding::passed));
    return count;
}

size_t SelftestReport::count_problems() const {
    return size_t(std::ranges::count_if(jobs, [](const Job &job) { return !job.problem.empty(); }));
}

const Finding *SelftestReport::find_check(size_t variant, const std::string &check) const {
    for (const Job &job : jobs)
        if (job.variant == variant)
            for (const Finding &finding : job.findings)
                if (finding.check == check)
                    return &finding;
    return nullptr;
}

std::string SelftestReport::row(const Finding &check) const {
    std::string line = fmt::format("{:<52}{:>10}", check.check, fmt::format("{:.3g}", check.limit)), worst;
    for (size_t v = 0; v < variants.size(); v++) {
        const Finding *finding = find_check(v, check.check);
        line += fmt::format("{:>12}{}", finding ? fmt::format("{:.3g}", finding->figure) : "-",
                            finding && !finding->passed ? "!" : " ");
        if (finding && !finding->passed && !finding->subject.empty())
            worst = fmt::format("    worst: {}\n", finding->subject);
    }
    return line + "\n" + worst;
}

std::string SelftestReport::text() const {
    std::string text = fmt::format("{:<52}{:>10}", "check", "limit");
    for (const Variant &variant : variants)
        text += fmt::format("{:>13}", variant.name());
    text += "\n";
    std::set<std::string> done;
    for (const Job &job : jobs)
        for (const Finding &finding : job.findings)
            if (done.insert(finding.check).second)
                text += row(finding);
    for (const Job &job : jobs)
        if (!job.problem.empty())
            text += fmt::format("{} at {}: {}\n", job.group->name, variants[job.variant].name(), job.problem);
    const size_t checks = count_checks(), problems = count_problems();
    return text + fmt::format("{}: {} of {} checks passed{}, {:.0f} s\n", passed() ? "passed" : "FAILED",
                              checks - count_failed(), checks,
                              problems ? fmt::format(", {} groups did not end well", problems) : "", seconds);
}

nlohmann::json SelftestReport::json() const {
    nlohmann::json report = object({{"device", device}, {"checks", nlohmann::json::array()}});
    for (const Job &job : jobs) {
        const Variant &variant = variants[job.variant];
        for (const Finding &f : job.findings)
            report["checks"].push_back(object({{"check", f.check},
                                               {"lanes", variant.lanes},
                                               {"math", variant.math},
                                               {"figure", f.figure},
                                               {"limit", f.limit},
                                               {"passed", f.passed},
                                               {"worst", f.subject}}));
        if (!job.problem.empty())
            report["checks"].push_back(object({{"check", job.group->name},
                                               {"lanes", variant.lanes},
                                               {"math", variant.math},
                                               {"passed", false},
                                               {"problem", job.problem}}));
    }
    return report;
}

int run(const Options &o) {
    prepare_json(o.json);
    const DevicePick pick = choose_device(o.device);
    info(fmt::format("device  {}", text_of(pick)));
    const std::vector<Variant> variants = variants_of(pick.info);
    std::vector<Job> jobs;
    for (const CheckGroup &group : check_groups())
        if (o.groups.empty() || std::find(o.groups.begin(), o.groups.end(), group.name) != o.groups.end())
            for (size_t v = 0; v < variants.size(); v++)
                jobs.push_back({&group, v, {}, {}});
    const auto begun = ChildProcess::Clock::now();
    run_jobs(jobs, variants, pick.info, o);
    const SelftestReport report{pick.info, variants, jobs,
                                std::chrono::duration<double>(ChildProcess::Clock::now() - begun).count()};
    print_text(report.text());
    write_json(o.json, "selftest", report.json());
    return report.passed() ? exit_done : exit_check_failed;
}

// The hidden command that a job runs: one group, whose findings it prints.
int run_group(const std::vector<std::string> &words) {
    begin_answer();
    if (words.size() < 6)
        throw Error("selftest-group is started by opal selftest");
    const CheckGroup &group = find_row(check_groups(), "group", words[0]);
    try {
        const Device device = open_device(parse_json(words[1]).get<DeviceInfo>());
        const Sources sources = load_sources(words.size() < 7 ? "" : words[6]);
        SelftestOptions options;
        options.build.lanes = std::stoi(words[2]);
        options.build.math = words[3] == "fast" ? MathMode::fast : MathMode::precise;
        options.full = words[4] == "full";
        options.seed = unsigned(std::stoul(words[5]));
        options.sources = &sources;
        for (const Finding &f : group.run(device, options))
            answer(dump(object({{"check", f.check},
                                {"figure", f.figure},
                                {"limit", f.limit},
                                {"passed", f.passed},
                                {"subject", f.subject}})));
    } catch (const std::exception &error) {
        answer(dump(object({{"problem", error.what()}})));
    }
    return 0;
}

} // namespace

Command selftest_command() {
    auto o = std::make_shared<Options>();
    std::string groups;
    for (const CheckGroup &group : check_groups())
        groups += fmt::format("\n  {}: {}", group.name, group.help);
    return {.name = "selftest",
            .help = "Check that a device and its driver compute right",
            .options = {device_row(o->device),
                        {.flags = "--quick", .target = &o->quick, .help = "Less than a minute [this, unless --full]"},
                        {.flags = "--full",
                         .target = &o->full,
                         .help = "More cases, more samples: minutes",
                         .excludes = "--quick"},
                        {.flags = "--group",
                         .target = &o->groups,
                         .help = "Only this group of checks; may be repeated" + groups,
                         .check = Accepts{[](const std::string &name) { find_row(check_groups(), "group", name); },
                                          names_of(check_groups())},
                         .type = "NAME"},
                        {.flags = "--time-limit",
                         .target = &o->time_limit,
                         .help = "Seconds for each group of checks [120, or 1200 with --full]",
                         .check = Positive{}},
                        {.flags = "--seed", .target = &o->seed, .help = "Seed of the random numbers"},
                        json_row(o->json, "the findings"),
                        cl_dir_row(o->cl_dir)},
            .examples = {"opal selftest", "opal selftest --full --device gpu --json selftest.json"},
            .run = [o] { return run(*o); }};
}

Command selftest_group_command() {
    auto words = std::make_shared<std::vector<std::string>>();
    return {
        .name = "selftest-group",
        .help = "",
        .options = {{.flags = "words", .target = words.get(), .help = "GROUP DEVICE LANES MATH EFFORT SEED [FOLDER]"}},
        .run = [words] { return run_group(*words); }};
}

} // namespace opal
