#include "sweep/run.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/log.h"
#include "base/progress.h"
#include "render/report.h"
#include "strategies/combinations.h"
#include "sweep/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>

namespace opal {

namespace {

constexpr double max_pilot_seconds = 0.5;     // for one pilot
constexpr double max_pilots_seconds = 5;      // for all pilots together, without a budget
constexpr double pilots_share = 0.1;          // of the budget, for all pilots together
constexpr double equal_time_tolerance = 0.05; // of the times of "what each gives in the same time"
constexpr unsigned equal_time_reruns = 2;
constexpr unsigned reference_factor = 8; // the reference's spp over the largest spp

class SweepRunner {
public:
    SweepRunner(const SweepPlan &plan, const Device &device, const std::vector<Candidate> &candidates,
                SweepRecord &record)
        : plan_(plan), device_(device), candidates_(candidates), record_(record), compiled_(candidates.size()) {}

    size_t renderers_made() const { return renderers_made_; }

    void measure_points() {
        progress_.emplace("pilots");
        run_pilots();
        best_ = size_t(
            std::ranges::min_element(candidates_, {}, [&](const Candidate &c) { return record_of(c).pilot_cost; }) -
            candidates_.begin());
        fit_budget();
        progress_.emplace("sweep");
        expect();
        make_reference();
        expect();
        for (unsigned round = 1; round <= record_.replicates; round++)
            run_round(round);
    }

    void render_equal_time_images() {
        progress_.emplace("images");
        if (reference_.layers.empty() && !read_reference())
            throw Error(reference_file().string() + ": is not there as it was written");
        for (size_t i = 0; i < candidates_.size(); i++) {
            render_equal_time_image(i);
            compiled_[i].reset();
            progress_->update(double(i + 1), double(candidates_.size()));
        }
    }

private:
    void note_scene(Image &image) const {
        image.metadata.insert({{"opal.dialect", record_.dialect}, {"opal.scene_hash", record_.scene_hash}});
    }
    StrategyRecord &record_of(const Candidate &c) { return record_.strategy(c.name, c.label); }
    const StrategyRecord &best() { return record_of(candidates_[best_]); }
    void save_record() { save(record_, plan_.folder); }
    CompiledStrategy compile(const Candidate &c) {
        progress_->tell("compile " + c.label);
        renderers_made_++;
        return CompiledStrategy(device_, c, *plan_.sources, plan_.clock);
    }
    // The candidate's compiled strategy, which the first use compiles. It is kept up to the candidate's image at equal
    // time. All share the memory of one film.
    CompiledStrategy &compiled(size_t candidate) {
        const Candidate &c = candidates_[candidate];
        if (!compiled_[candidate]) {
            compiled_[candidate] = std::make_unique<CompiledStrategy>(compile(c));
            const auto other =
                std::ranges::find_if(compiled_, [&](const auto &one) { return one && one != compiled_[candidate]; });
            if (other != compiled_.end())
                compiled_[candidate]->share_film(**other);
        }
        progress_->tell(c.label);
        return *compiled_[candidate];
    }
    // The part of the budget for this device.
    double device_budget() const { return record_.budget / double(record_.devices.size()); }

    void run_pilots() {
        if (std::all_of(candidates_.begin(), candidates_.end(),
                        [&](const Candidate &c) { return record_of(c).pilot_cost > 0; }))
            return;
        const double together = record_.budget > 0 ? pilots_share * device_budget() : max_pilots_seconds;
        const double share = std::fmin(max_pilot_seconds, together / double(candidates_.size()));
        std::vector<Pilot> all;
        for (size_t i = 0; i < candidates_.size(); i++) {
            StrategyRecord &s = record_of(candidates_[i]);
            CompiledStrategy &strategy = compiled(i);
            all.push_back(run_pilot(strategy, plan_.seed, share));
            progress_->update(double(all.size()), double(candidates_.size()));
            s.independent = candidates_[i].scene.strategy[AXIS_sampler] == CHOICE_sampler_independent;
            s.compile_seconds = strategy.compile_seconds();
            s.lanes = strategy.lanes();
            s.pilot_seconds_a_sample = all.back().seconds_a_sample;
            info(fmt::format("pilot   {}: {:.3g} ms a sample of each pixel", s.label, 1e3 * s.pilot_seconds_a_sample));
        }
        const std::vector<double> costs = pilot_costs(all);
        for (size_t i = 0; i < costs.size(); i++)
            record_of(candidates_[i]).pilot_cost =
                std::isfinite(costs[i]) ? std::fmax(costs[i], 1e-30) : 1e300; // 0 means that there is no pilot yet
        save_record();
    }

    const SweepPoint *find_point(const StrategyRecord &s, unsigned spp) const {
        for (const SweepPoint &p : s.points)
            if (p.spp == spp)
                return &p;
        return nullptr;
    }

    unsigned missing_replicates(const StrategyRecord &s, unsigned spp) const {
        const SweepPoint *p = find_point(s, spp);
        return record_.replicates - unsigned(p ? std::min<size_t>(p->replicates.size(), record_.replicates) : 0);
    }

    unsigned reference_spp() const {
        return plan_.reference_spp ? plan_.reference_spp : reference_factor * record_.spp.back();
    }

    // The seconds that the missing measurements will take, by the pilots.
    double seconds_left() {
        double seconds =
            record_.reference.made_by.empty() && !plan_.reference ? reference_spp() * best().pilot_seconds_a_sample : 0;
        for (const Candidate &c : candidates_)
            for (unsigned spp : record_.spp)
                seconds += missing_replicates(record_of(c), spp) * double(spp) * record_of(c).pilot_seconds_a_sample;
        return seconds;
    }

    // Tells the progress bar how long the rest takes: renders, by the pilots and the time on the wall that a second of
    // theirs has taken so far, with the writing of results; compilations; and the images at equal time.
    void expect() {
        double compiling = 0, fastest = INFINITY;
        for (size_t i = 0; i < candidates_.size(); i++) {
            const StrategyRecord &s = record_of(candidates_[i]);
            compiling += compiled_[i] ? 0 : s.compile_seconds;
            fastest = std::fmin(fastest, s.pilot_seconds_a_sample);
        }
        const double images = double(candidates_.size()) * record_.spp.back() * fastest;
        const double pace = planned_done_ > 0 ? wall_done_ / planned_done_ : 1;
        progress_->expect(compiling + pace * (seconds_left() + images));
    }

    // Counts a render into the pace. begun: before it; planned: its seconds by the pilots.
    void count_render(std::chrono::steady_clock::time_point begun, double planned) {
        wall_done_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
        planned_done_ += planned;
        expect();
    }

    // Leaves out the largest spp until the rest fits the budget.
    void fit_budget() {
        double seconds = seconds_left();
        for (; record_.budget > 0 && seconds > device_budget(); seconds = seconds_left()) {
            if (record_.spp.size() == 1)
                throw Error(fmt::format(
                    "--budget {:g}s: {} samples per pixel alone take about {:.3g} s; give more, or fewer strategies, "
                    "--replicates or --spp",
                    record_.budget, record_.spp[0], seconds));
            record_.left_out_spp.insert(record_.left_out_spp.begin(), record_.spp.back());
            record_.spp.pop_back();
        }
        if (!record_.left_out_spp.empty())
            warn(fmt::format("--budget {:g}s: leaves out {} samples per pixel", record_.budget,
                             fmt::join(record_.left_out_spp, ", ")));
        info(fmt::format("plan    {} strategies, {} samples per pixel, {} replicates: about {:.3g} s",
                         candidates_.size(), fmt::join(record_.spp, ", "), record_.replicates, seconds));
    }

    std::filesystem::path reference_file() const { return plan_.folder / "reference.exr"; }

    // Renders an image of the sweep. Throws Error if no error could be measured with it.
    static CompiledStrategy::RenderResult render(CompiledStrategy &strategy, const std::string &label, unsigned spp,
                                                 unsigned seed, unsigned first = 0) {
        CompiledStrategy::RenderResult r = strategy.render(spp, seed, first);
        if (const ImageFault fault = find_fault(r.image, statistics_of(r.film)))
            throw Error(fmt::format("{}: {}; its error cannot be measured", label, fault.text()));
        return r;
    }

    // Reads the reference that was given or rendered before. False: it is not there as it was written.
    bool read_reference() {
        if (plan_.reference) {
            reference_ = *plan_.reference;
            return true;
        }
        FileHashes hashes;
        try {
            reference_ = read_exr(reference_file(), &hashes);
        } catch (const Error &) {
            return false;
        }
        return hashes.value() == record_.reference.hash;
    }

    // The strategy that renders the reference: the best, with independent samples, and without fast math, which is
    // itself measured against the reference. It is compiled into `own` unless it is a candidate.
    CompiledStrategy &reference_strategy(std::optional<CompiledStrategy> &own) {
        Candidate wanted = candidates_[best_];
        wanted.scene.strategy[AXIS_sampler] = CHOICE_sampler_independent;
        if (wanted.scene.strategy.math == MathMode::fast)
            wanted.scene.strategy.math = MathMode::precise;
        for (size_t i = 0; i < candidates_.size(); i++)
            if (is_same(candidates_[i].scene.strategy, wanted.scene.strategy))
                return compiled(i);
        wanted.label = "the reference";
        return own.emplace(compile(wanted));
    }

    void make_reference() {
        ReferenceRecord &r = record_.reference;
        if (plan_.reference) {
            read_reference();
            r = {record_.reference_file, 0, 0, mean_luminance(reference_), 0, reference_.find("variance.R") != nullptr};
        } else if (!r.made_by.empty() && read_reference()) {
            if (r.spp < 2 * record_.spp.back())
                warn(fmt::format("the reference of the sweep that is continued has {} samples per pixel only", r.spp));
        } else {
            const ReferenceRecord before = r; // that the replicates were measured with, if any
            if (!before.made_by.empty()) {
                warn(fmt::format("{}: is missing or was changed; it is rendered again", reference_file().string()));
                best_ = size_t(std::ranges::find(candidates_, before.made_by, &Candidate::name) - candidates_.begin());
                if (best_ == candidates_.size())
                    throw Error(fmt::format("{}: only strategy {}, which is not among these, can render it again",
                                            reference_file().string(), before.made_by));
            }
            std::optional<CompiledStrategy> own;
            CompiledStrategy &strategy = reference_strategy(own);
            const unsigned half = ((before.made_by.empty() ? reference_spp() : before.spp) + 1) / 2;
            const auto begun = std::chrono::steady_clock::now();
            const auto a = render(strategy, best().label, half, plan_.seed, first_reference_sample_a),
                       b = render(strategy, best().label, half, plan_.seed, first_reference_sample_b);
            const FilmStatistics sa = statistics_of(a.film), sb = statistics_of(b.film);
            reference_ = reference_from_halves(a.image, b.image);
            reference_.crop = a.image.crop;
            note_scene(reference_);
            const std::string bytes = exr_bytes(reference_);
            FileHashes hashes;
            hashes.add(bytes);
            if (!before.made_by.empty() && hashes.value() != before.hash)
                throw Error(reference_file().string() +
                            ": cannot be rendered again as it was; give another folder with -o");
            write_safely(reference_file(), bytes);
            r = {best().name,
                 2 * half,
                 a.seconds + b.seconds,
                 (sa.mean_luminance + sb.mean_luminance) / 2,
                 std::hypot(sa.stderr_luminance, sb.stderr_luminance) / 2,
                 true,
                 0,
                 hashes.value()};
            info(fmt::format("reference by {}: {} samples per pixel, {:.3g} s", best().label, r.spp, r.seconds));
            count_render(begun, r.spp * best().pilot_seconds_a_sample);
        }
        r.mean_square = mean_square(reference_);
        if (!is_whole_picture(plan_.folder / "reference.png"))
            write_png(reference_, plan_.folder / "reference.png");
        save_record();
    }

    // Renders a replicate of each point that has fewer than `round`.
    void run_round(unsigned round) {
        double seconds = 0;
        for (size_t i = 0; i < candidates_.size(); i++)
            for (unsigned spp : record_.spp) {
                std::vector<Replicate> &replicates = point(record_of(candidates_[i]), spp).replicates;
                if (replicates.size() >= round)
                    continue;
                const unsigned seed = plan_.seed + round;
                CompiledStrategy &strategy = compiled(i);
                const auto begun = std::chrono::steady_clock::now();
                const CompiledStrategy::RenderResult r = render(strategy, record_of(candidates_[i]).label, spp, seed);
                const ImageError error = error_against(reference_, r.image);
                replicates.push_back(
                    {seed, r.seconds, error.mse, error.rel_mse, statistics_of(r.film).mean_luminance, r.film.invalid});
                seconds += r.seconds;
                save_record();
                count_render(begun, spp * record_of(candidates_[i]).pilot_seconds_a_sample);
            }
        if (seconds > 0)
            info(fmt::format("round   {} of {}: {:.3g} s", round, record_.replicates, seconds));
    }

    SweepPoint &point(StrategyRecord &s, unsigned spp) {
        if (!find_point(s, spp)) {
            s.points.push_back({spp, {}});
            std::sort(s.points.begin(), s.points.end(),
                      [](const SweepPoint &a, const SweepPoint &b) { return a.spp < b.spp; });
        }
        return *std::find_if(s.points.begin(), s.points.end(), [&](const SweepPoint &p) { return p.spp == spp; });
    }

    // The time that every strategy gets: that of the fastest strategy for the most samples.
    double equal_time_seconds() {
        double seconds = INFINITY;
        for (const StrategyRecord &s : record_.strategies)
            if (!s.points.empty())
                seconds = std::fmin(seconds, s.points.back().replicates[0].seconds);
        return seconds;
    }

    // Renders in equal_time_seconds, within equal_time_tolerance where samples are short enough for that: the samples
    // per pixel follow from the rate of the last render.
    void render_equal_time_image(size_t candidate) {
        StrategyRecord &s = record_of(candidates_[candidate]);
        const double wanted = equal_time_seconds();
        const auto is_equal = [&](double seconds) {
            return std::abs(seconds - wanted) <= equal_time_tolerance * wanted;
        };
        const std::filesystem::path stem =
            plan_.folder / ("equal_time_" + std::to_string(&s - record_.strategies.data() + 1));
        const std::array files = {stem.string() + ".exr", stem.string() + ".png", stem.string() + "_error.png"};
        if (s.shot.spp > 0 && is_equal(s.shot.seconds) &&
            std::ranges::all_of(files, [](const std::string &file) { return is_whole_picture(file); }))
            return;
        CompiledStrategy &strategy = compiled(candidate);
        CompiledStrategy::RenderResult r;
        unsigned spp = s.points.back().spp;
        double seconds = s.points.back().replicates[0].seconds;
        for (unsigned run = 0; run <= equal_time_reruns && !(run > 0 && is_equal(seconds)); run++) {
            const double ratio = seconds > 0 ? wanted / seconds : 1;
            const unsigned next = unsigned(std::clamp(std::round(spp * ratio), 1.0, double(first_pilot_sample)));
            if (run > 0 && next == spp)
                break;
            spp = next;
            r = render(strategy, s.label, spp, plan_.seed + 1);
            seconds = r.seconds;
        }
        note_scene(r.image);
        write_exr(r.image, files[0]);
        write_png(r.image, files[1]);
        write_png(error_map(reference_, r.image), files[2]);
        s.shot = {spp, seconds, error_against(reference_, r.image).rel_mse, stem.filename().string()};
        save_record();
    }

    const SweepPlan &plan_;
    const Device &device_;
    const std::vector<Candidate> &candidates_;
    SweepRecord &record_;
    size_t best_ = 0;                                         // candidate
    std::vector<std::unique_ptr<CompiledStrategy>> compiled_; // by candidate
    size_t renderers_made_ = 0;
    Image reference_;
    std::optional<RunningProgress> progress_;
    double wall_done_ = 0, planned_done_ = 0; // seconds of the renders so far: on the wall, and by the pilots
};

} // namespace

size_t run_sweep(const SweepPlan &plan, const Device &device, const std::vector<Candidate> &candidates,
                 SweepRecord &record, SweepPart part) {
    SweepRunner runner(plan, device, candidates, record);
    if (part != SweepPart::images)
        runner.measure_points();
    if (part != SweepPart::points)
        runner.render_equal_time_images();
    return runner.renderers_made();
}

} // namespace opal
