#include "stats/quadrature.h"

#include "stats/moments.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace opal::stats {
namespace {

// Nodes on [-1, 1] with the weights of Kronrod's rule of 15 points and of Gauss's of 7, which uses every second one.
struct Node {
    double x, kronrod, gauss;
};
constexpr std::array<Node, 15> make_rule() {
    constexpr std::array<Node, 8> half = {
        {{0.991455371120812639206854697526329, 0.022935322010529224963732008058970, 0},
         {0.949107912342758524526189684047851, 0.063092092629978553290700663189204,
          0.129484966168869693270611432679082},
         {0.864864423359769072789712788640926, 0.104790010322250183839876322541518, 0},
         {0.741531185599394439863864773280788, 0.140653259715525918745189590510238,
          0.279705391489276667901467771423780},
         {0.586087235467691130294144691258730, 0.169004726639267902826583426598550, 0},
         {0.405845151377397166906606412076961, 0.190350578064785409913256402421014,
          0.381830050505118944950369775488975},
         {0.207784955007898467600689403773245, 0.204432940075298892414161999234649, 0},
         {0, 0.209482141084727828012999174891714, 0.417959183673469387755102040816327}}};
    std::array<Node, 15> rule{};
    for (int i = 0; i < 15; ++i) {
        rule[i] = half[i < 8 ? i : 14 - i];
        rule[i].x = i < 8 ? -rule[i].x : rule[i].x;
    }
    return rule;
}
constexpr std::array<Node, 15> rule = make_rule();
constexpr size_t points_2d = rule.size() * rule.size();
constexpr size_t batch_pieces = 2048; // bounds the memory of one call: about half a million points

struct Piece {
    Rectangle r;
    size_t cell = 0;
    double value = 0, error_x = 0, error_y = 0;
    double error() const { return error_x + error_y; }
};

double at(double lo, double hi, double x) { return lo + (hi - lo) * (1 + x) / 2; }

// The ends of [lo, hi] and the splits strictly between, ascending, no two equal.
std::vector<double> breaks(double lo, double hi, const std::vector<double> &splits) {
    std::vector<double> b = {lo, hi};
    for (double s : splits)
        if (s > lo && s < hi)
            b.push_back(s);
    std::sort(b.begin(), b.end());
    b.erase(std::unique(b.begin(), b.end()), b.end());
    return b;
}

// Value and errors of a piece from the integrand at its points, row by row.
void apply_rule(Piece &piece, const double *f) {
    double kk = 0, gk = 0, kg = 0; // first letter: the rule in x
    for (const Node &y : rule) {
        double row_k = 0, row_g = 0;
        for (const Node &x : rule) {
            row_k += x.kronrod * *f;
            row_g += x.gauss * *f++;
        }
        kk += y.kronrod * row_k;
        gk += y.kronrod * row_g;
        kg += y.gauss * row_k;
    }
    double scale = piece.r.area() / 4;
    piece.value = kk * scale;
    piece.error_x = std::abs(kk - gk) * scale;
    piece.error_y = std::abs(kk - kg) * scale;
}

void evaluate(const BatchFunction2 &f, std::span<Piece> pieces) {
    std::vector<Point2> points;
    std::vector<double> values;
    for (size_t first = 0; first < pieces.size(); first += batch_pieces) {
        std::span<Piece> batch = pieces.subspan(first, std::min(batch_pieces, pieces.size() - first));
        points.clear();
        for (const Piece &p : batch)
            for (const Node &y : rule)
                for (const Node &x : rule)
                    points.push_back({at(p.r.x0, p.r.x1, x.x), at(p.r.y0, p.r.y1, y.x)});
        values.assign(points.size(), NAN);
        f(points, values);
        for (size_t i = 0; i < batch.size(); ++i)
            apply_rule(batch[i], &values[i * points_2d]);
    }
}

std::array<Piece, 2> halve(const Piece &p) {
    std::array<Piece, 2> halves = {p, p};
    if (p.error_x >= p.error_y)
        halves[0].r.x1 = halves[1].r.x0 = (p.r.x0 + p.r.x1) / 2;
    else
        halves[0].r.y1 = halves[1].r.y0 = (p.r.y0 + p.r.y1) / 2;
    return halves;
}

// Sums the pieces of each cell; also counts them.
std::vector<Integral> sum_cells(std::span<const Piece> pieces, size_t cells, const QuadratureOptions &options,
                                std::vector<size_t> &count) {
    std::vector<CompensatedSum> values(cells), errors(cells);
    count.assign(cells, 0);
    for (const Piece &p : pieces) {
        values[p.cell].add(p.value);
        errors[p.cell].add(p.error());
        ++count[p.cell];
    }
    std::vector<Integral> sums;
    for (size_t i = 0; i < cells; ++i) {
        double value = values[i].value(), error = errors[i].value();
        sums.push_back({value, error, error <= std::max(options.relative * std::abs(value), options.absolute)});
    }
    return sums;
}

} // namespace

std::vector<double> splits_about(double center, double width, double low, double high) {
    std::vector<double> splits;
    if (center > low && center < high)
        splits.push_back(center);
    for (double d = width; d > 0 && d < high - low; d *= 4)
        for (double s : {center - d, center + d})
            if (s > low && s < high)
                splits.push_back(s);
    std::sort(splits.begin(), splits.end());
    return splits;
}

std::vector<Integral> integrate_cells(const BatchFunction2 &f, std::span<const Rectangle> cells,
                                      const QuadratureOptions &options) {
    std::vector<Piece> pieces, next;
    for (size_t cell = 0; cell < cells.size(); ++cell) {
        auto xs = breaks(cells[cell].x0, cells[cell].x1, options.splits_x);
        auto ys = breaks(cells[cell].y0, cells[cell].y1, options.splits_y);
        for (size_t i = 0; i + 1 < xs.size(); ++i)
            for (size_t j = 0; j + 1 < ys.size(); ++j)
                pieces.push_back({{xs[i], xs[i + 1], ys[j], ys[j + 1]}, cell});
    }
    evaluate(f, pieces);
    size_t evaluations = pieces.size() * points_2d;
    for (;;) {
        std::vector<size_t> count;
        std::vector<Integral> sums = sum_cells(pieces, cells.size(), options, count);
        next.clear();
        std::erase_if(pieces, [&](const Piece &p) {
            const Integral &sum = sums[p.cell];
            double tolerance = std::max(options.relative * std::abs(sum.value), options.absolute);
            if (sum.converged || !(p.error() > tolerance / double(count[p.cell]))) // also where NaN spoils the cell
                return false;
            for (const Piece &half : halve(p))
                next.push_back(half);
            return true;
        });
        evaluations += next.size() * points_2d;
        if (next.empty() || evaluations > options.max_evaluations)
            return sums;
        evaluate(f, next);
        pieces.insert(pieces.end(), next.begin(), next.end());
    }
}

Integral integrate(const Function2 &f, const Rectangle &rectangle, const QuadratureOptions &options) {
    auto batch = [&](std::span<const Point2> points, std::span<double> values) {
        std::transform(points.begin(), points.end(), values.begin(), f);
    };
    return integrate_cells(batch, std::span(&rectangle, 1), options)[0];
}

Integral integrate(const Function1 &f, double a, double b, const QuadratureOptions &options) {
    struct Piece1 {
        double lo, hi, value = 0, error = 0;
    };
    auto apply = [&](double lo, double hi) {
        double kronrod = 0, gauss = 0;
        for (const Node &node : rule) {
            double y = f(at(lo, hi, node.x));
            kronrod += node.kronrod * y;
            gauss += node.gauss * y;
        }
        return Piece1{lo, hi, kronrod * (hi - lo) / 2, std::abs(kronrod - gauss) * (hi - lo) / 2};
    };
    auto smaller = [](const Piece1 &p, const Piece1 &q) { return p.error < q.error; };
    std::vector<Piece1> heap;
    std::vector<double> ends = breaks(a, b, options.splits_x);
    for (size_t i = 0; i + 1 < ends.size(); ++i)
        heap.push_back(apply(ends[i], ends[i + 1]));
    std::make_heap(heap.begin(), heap.end(), smaller);
    CompensatedSum value, error;
    for (const Piece1 &p : heap)
        value.add(p.value), error.add(p.error);
    for (size_t evaluations = heap.size() * rule.size();; evaluations += 2 * rule.size()) {
        Integral sum = {value.value(), error.value(), false};
        sum.converged = sum.error <= std::max(options.relative * std::abs(sum.value), options.absolute);
        if (sum.converged || !std::isfinite(sum.error) || evaluations > options.max_evaluations)
            return sum;
        std::pop_heap(heap.begin(), heap.end(), smaller);
        Piece1 worst = heap.back();
        heap.pop_back();
        value.add(-worst.value), error.add(-worst.error);
        double middle = (worst.lo + worst.hi) / 2;
        for (const Piece1 &half : {apply(worst.lo, middle), apply(middle, worst.hi)}) {
            value.add(half.value), error.add(half.error);
            heap.push_back(half);
            std::push_heap(heap.begin(), heap.end(), smaller);
        }
    }
}

} // namespace opal::stats
