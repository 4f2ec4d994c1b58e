#!/usr/bin/env python3
"""Writes a C++ source that holds every file below a cl/ folder: embed_cl.py CL_FOLDER OUT.cpp"""
import pathlib
import sys

DELIMITER = "opal_cl"


def literal(text: str) -> str:
    if f"){DELIMITER}\"" in text:
        raise SystemExit(f"embed_cl.py: a file holds the delimiter )" + DELIMITER)
    return f'R"{DELIMITER}({text}){DELIMITER}"'


def main(folder: pathlib.Path, out: pathlib.Path) -> None:
    files = sorted(f for f in folder.rglob("*") if f.suffix in (".cl", ".h"))
    rows = [f'    {{"{f.relative_to(folder).as_posix()}", {literal(f.read_text())}}},' for f in files]
    out.write_text(
        "// Written by scripts/embed_cl.py from cl/.\n"
        '#include "device/embedded.h"\n\n'
        "namespace opal {\n\n"
        "const std::map<std::string, std::string> &embedded_files() {\n"
        "    static const std::map<std::string, std::string> files = {\n"
        + "\n".join(rows)
        + "\n    };\n    return files;\n}\n\n} // namespace opal\n"
    )


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
