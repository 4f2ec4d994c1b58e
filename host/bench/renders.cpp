#include "bench/renders.h"

#include "bvh/collapse.h"

#include <algorithm>
#include <ctime>

namespace opal {

RenderBench::RenderBench(const Device &device, const FlatScene &scene, const BuildOptions &build,
                         const Sources &sources, double seconds, int rounds)
    : device_(device), scene_(scene), build_(build), sources_(sources), base_(renderer_of(scene, build)),
      rounds_(rounds) {
    for (double share : {0.0, 0.1, 1.0}) // pilots: one sample, one again now that all is warm, a tenth of the time
        spp_ = std::max(1u, unsigned(share * seconds * spp_ / render(base_, 1000).device));
}

Renderer RenderBench::renderer_of(const FlatScene &scene, const BuildOptions &build) const {
    RenderOptions options;
    options.build = build;
    options.sources = &sources_;
    return Renderer(device_, scene, options);
}

RenderBench::Timed RenderBench::render(Renderer &renderer, unsigned seed) const {
    renderer.restart(seed);
    const std::clock_t before = std::clock();
    renderer.render(spp_);
    return {renderer.kernel_seconds(), double(std::clock() - before) / CLOCKS_PER_SEC};
}

PathRates RenderBench::rates_of(const std::vector<Timed> &runs) const {
    const double paths = double(scene_.settings.width) * scene_.settings.height * spp_;
    std::vector<double> by_device, by_cpu;
    for (const Timed &run : runs) {
        by_device.push_back(paths / run.device);
        by_cpu.push_back(paths / run.cpu);
    }
    return {spread_of(by_device), spread_of(by_cpu)};
}

PathRates RenderBench::rates() {
    std::vector<Timed> runs;
    for (int round = 0; round < rounds_; round++)
        runs.push_back(render(base_, unsigned(round)));
    return rates_of(runs);
}

PathCounts RenderBench::counts() const {
    BuildOptions counting = build_;
    counting.count_tests = true;
    Renderer renderer = renderer_of(scene_, counting);
    const unsigned spp = std::min(spp_, 64u); // enough to keep lanes as full as in the timed renders
    renderer.render(spp);
    const Film film = renderer.film();
    double sum[3] = {};
    for (const auto &pixel : film.sum)
        for (size_t c = 0; c < 3; c++)
            sum[c] += pixel[c];
    const double paths = double(film.sum.size()) * spp;
    return {sum[0] / paths, sum[1] / paths, sum[0] / (sum[2] * build_.lanes)};
}

Race RenderBench::race(const FlatScene &scene, const BuildOptions &build) {
    Renderer other = renderer_of(scene, build);
    render(other, 1000);
    std::vector<Timed> runs;
    std::vector<double> times;
    for (int round = 0; round < rounds_; round++) {
        const Timed base = render(base_, unsigned(round));
        runs.push_back(render(other, unsigned(round)));
        times.push_back(device_.info.type == "cpu" ? runs.back().cpu / base.cpu : runs.back().device / base.device);
    }
    return {rates_of(runs), spread_of(times), other.compile_seconds()};
}

FlatScene with_feature(const FlatScene &scene, unsigned feature) {
    FlatScene changed = scene;
    changed.features.list[feature].on = true;
    if (changed.nodes.empty())
        changed.nodes.push_back(empty_node()); // the scene has no tree
    return changed;
}

} // namespace opal
