#!/usr/bin/env python3
"""Counts the lines of parsers that a harness has just reached: scripts/fuzz --reach runs it.

    reach.py [--missing] BUILD_FOLDER HARNESS     after a run of HARNESS, built with gcc's --coverage

parsers.txt says which files of src/ each harness is for, and which functions of them it is not for.
Prints a row of the table; with --missing also each line that was not reached.
"""
import json
import os
import re
import subprocess
import sys

here = os.path.dirname(os.path.abspath(__file__))


def list_parsers(harness):
    """The files of a harness, each with the functions that do not count."""
    parsers = []
    for line in open(os.path.join(here, "parsers.txt")):
        if line.split(":")[0] != harness:
            continue
        file, *left_out = line.split(":", 1)[1].split()
        parsers.append((file, {name.lstrip("-") for name in left_out}))
    return parsers


def find_object(folder, file):
    for at, _, names in os.walk(os.path.join(folder, "CMakeFiles")):
        if at.endswith("/src/" + os.path.dirname(file)) and os.path.basename(file) + ".gcda" in names:
            return os.path.join(at, os.path.basename(file) + ".gcda")
    return None


def count_lines(folder, file):
    """Of a file: how often each line ran, by (function, line)."""
    data = find_object(folder, file)
    if not data:
        return {}
    done = subprocess.run(["gcov", "--json-format", "--stdout", data], cwd=folder,
                          capture_output=True, text=True, check=True)
    counts = {}
    for entry in json.loads(done.stdout)["files"]:
        if not entry["file"].endswith("/src/" + file):
            continue
        for line in entry["lines"]:
            name = re.sub(r"\(.*|.*::", "", line.get("function_name", ""))
            at = (name, line["line_number"])
            counts[at] = counts.get(at, 0) + line["count"]
    return counts


def main():
    words = [word for word in sys.argv[1:] if word != "--missing"]
    folder, harness = words
    cells, missing = [], []
    for file, left_out in list_parsers(harness):
        counts = count_lines(folder, file)
        unknown = left_out - {name for name, _ in counts}
        if counts and unknown:
            sys.exit(f"parsers.txt: {file} has no function {', '.join(sorted(unknown))}")
        lines = {}
        for (name, line), count in counts.items():
            if name not in left_out:
                lines[line] = lines.get(line, 0) + count
        cells.append(f"{file} {sum(1 for count in lines.values() if count)} of {len(lines)}")
        missing += [(file, line) for line, count in sorted(lines.items()) if not count]
    files = len(os.listdir(os.path.join(here, "corpus", harness)))
    print(f"- `{harness}` ({files} files): {', '.join(cells)}")
    if "--missing" in sys.argv:
        for file, line in missing:
            text = open(os.path.join(here, "..", "..", "src", file)).readlines()[line - 1]
            print(f"    {file}:{line}: {text.rstrip()}")


main()
