#include "selftest/finding.h"

#include "stats/hypothesis.h"

#include <algorithm>

namespace opal {

namespace {

Finding summary_of_check(const std::string &check, const Findings &cases) {
    double figure = NAN, limit = 0, count = 0;
    FigureKind kind{};
    for (const Finding &finding : cases) {
        if (finding.check != check)
            continue;
        kind = finding.kind;
        limit = finding.limit;
        figure = count++ == 0                  ? finding.figure
                 : kind == FigureKind::p_value ? std::min(figure, finding.figure)
                 : kind == FigureKind::error   ? worst_of(figure, finding.figure)
                                               : figure + finding.figure;
    }
    return kind == FigureKind::p_value ? p_value(check, stats::sidak_p(figure, count))
           : kind == FigureKind::error ? at_most(check, figure, limit)
                                       : none_wrong(check, figure);
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
