#include "selftest/finding.h"

#include "stats/hypothesis.h"

#include <algorithm>
#include <cmath>

namespace opal {

namespace {

// Two findings of one check. Nothing is worse than a NaN.
bool is_worse(const Finding &a, const Finding &b) {
    if (std::isnan(a.figure) || std::isnan(b.figure))
        return !std::isnan(b.figure);
    return a.kind == FigureKind::p_value ? a.figure < b.figure : a.figure > b.figure;
}

// cases: with one of that check at least.
Finding summary_of_check(const std::string &check, const Findings &cases) {
    double figure = 0, count = 0;
    const Finding *worst = nullptr;
    for (const Finding &finding : cases) {
        if (finding.check != check)
            continue;
        if (!worst || is_worse(finding, *worst))
            worst = &finding;
        figure += finding.figure;
        count++;
    }
    switch (worst->kind) {
    case FigureKind::p_value:
        return p_value(check, stats::sidak_p(worst->figure, count), worst->subject);
    case FigureKind::error:
        return at_most(check, worst->figure, worst->limit, worst->subject);
    default:
        return none_wrong(check, figure, worst->subject);
    }
}

} // namespace

void append(Findings &findings, Findings more) {
    findings.insert(findings.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

Findings summary_of(const Findings &cases) {
    Findings summary;
    for (const Finding &finding : cases)
        if (std::none_of(summary.begin(), summary.end(), [&](const Finding &f) { return f.check == finding.check; }))
            summary.push_back(summary_of_check(finding.check, cases));
    return summary;
}

} // namespace opal
