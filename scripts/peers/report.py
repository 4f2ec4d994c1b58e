"""What the benchmarks of the peers share: their error, a spread, a table."""
import statistics


class PeerError(Exception):
    """Something a benchmark needs is missing or failed; the message says what and what to do."""


def spread(values):
    """'median [least, greatest]' of some measurements."""
    if not values:
        return "-"
    return f"{statistics.median(values):.3g} [{min(values):.3g}, {max(values):.3g}]"


def table(headings, rows):
    """A Markdown table, its columns aligned."""
    cells = [headings] + rows
    widths = [max(len(row[i]) for row in cells) for i in range(len(headings))]
    line = lambda row: "| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths)) + " |"
    return "\n".join([line(headings), "|" + "|".join("-" * (w + 2) for w in widths) + "|"] + [line(row) for row in rows])
