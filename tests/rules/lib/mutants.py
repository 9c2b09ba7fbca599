"""Deliberate faults of the solvers, as tests/mutants/*.txt list them. A row is

    name | file | program test
    - text before
    + text after

with as many lines of either as wanted, and an empty line after it. The text before stands in the
file once; a file that is not there any more is the one of its name elsewhere in src or shaders. The
test, of tests/gpu or tests/unit, fails with the text after."""
import functools
import os
from collections import namedtuple

from lib import house

Mutant = namedtuple("Mutant", "name path program test before after where")
FOLDER = "tests/mutants"


def locate(top, path, known):
    """The path, or the only one below its first folder with the same name."""
    if os.path.isfile(os.path.join(top, path)):
        return path
    same = [other for other in known(path.split("/")[0]) if os.path.basename(other) == os.path.basename(path)]
    return same[0] if len(same) == 1 else path


def read(top):
    """(mutants, offences of how they are written)"""
    mutants, offences = [], []

    @functools.cache
    def known(folder):
        return house.files(top, folder)

    for path in house.files(top, FOLDER, ".txt"):
        head, before, after = None, [], []
        for number, line in enumerate(house.lines(top, path) + [""], 1):
            if line.startswith("#"):
                continue
            if line.startswith("- "):
                before.append(line[2:])
            elif line.startswith("+ ") or line == "+":
                after.append(line[2:])
            elif line:
                head = line, f"{path}:{number}"
            elif head:
                parts = [part.strip() for part in head[0].split(" | ")]
                test = parts[-1].split()
                if len(parts) == 3 and len(test) == 2 and before and after:
                    mutants.append(Mutant(parts[0], locate(top, parts[1], known), *test, "\n".join(before),
                                          "\n".join(after), head[1]))
                else:
                    offences.append(f"{head[1]}: wanted 'name | file | program test', lines "
                                    "'- before' and lines '+ after'")
                head, before, after = None, [], []
    return mutants, offences


def text(top, path):
    with open(os.path.join(top, path), encoding="utf-8") as f:
        return f.read()


def find_offences(top, mutants):
    names = set()
    for m in mutants:
        if m.name in names:
            yield f"{m.where}: there are two '{m.name}'"
        names.add(m.name)
        if not os.path.isfile(os.path.join(top, m.path)):
            yield f"{m.where}: there is no {m.path}"
            continue
        found = text(top, m.path).count(m.before)
        if found != 1:
            yield f"{m.where}: its text stands in {m.path} {found} times, not once"
        if m.before == m.after:
            yield f"{m.where}: it changes nothing"
        kind, _, rest = m.program.partition("_")
        test = f"tests/{kind}/{rest}.c"
        if not os.path.isfile(os.path.join(top, test)):
            yield f"{m.where}: there is no {test}"
        elif f"cmocka_unit_test({m.test})" not in text(top, test):
            yield f"{m.where}: {test} has no test {m.test}"
