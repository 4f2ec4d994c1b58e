#include "stats/bootstrap.h"

#include "stats/hypothesis.h"
#include "stats/special.h"

#include <cmath>
#include <numeric>
#include <random>

namespace opal::stats {

std::vector<std::vector<size_t>> bootstrap_draws(size_t n, size_t count, unsigned seed) {
    std::vector<std::vector<size_t>> draws(count, std::vector<size_t>(n));
    std::mt19937 engine(seed);
    for (std::vector<size_t> &draw : draws)
        for (size_t &index : draw)
            index = size_t(engine()) * n >> 32; // std::uniform_int_distribution differs between libraries
    return draws;
}

Interval bootstrap_interval(const std::vector<std::vector<size_t>> &draws, double confidence,
                            const std::function<double(const std::vector<size_t> &)> &statistic) {
    const size_t n = draws.empty() ? 0 : draws[0].size();
    std::vector<size_t> all(n);
    std::iota(all.begin(), all.end(), size_t(0));
    Interval interval{n > 0 ? statistic(all) : std::numeric_limits<double>::quiet_NaN(), 0};
    if (n < 2 || !(interval.estimate > 0 && std::isfinite(interval.estimate)))
        return interval;
    Moments logarithms;
    for (const std::vector<size_t> &draw : draws) {
        const double value = statistic(draw);
        if (!(value > 0 && std::isfinite(value)))
            return interval;
        logarithms.add(std::log(value));
    }
    const double error = std::sqrt(logarithms.variance() * double(n) / double(n - 1));
    const double half_width = -student_t_quantile((1 - confidence) / 2, double(n - 1)) * error;
    interval.low = interval.estimate * std::exp(-half_width);
    interval.high = interval.estimate * std::exp(half_width);
    return interval;
}

} // namespace opal::stats
