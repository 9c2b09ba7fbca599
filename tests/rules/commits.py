"""Subjects of commits: `area/file: lower-case verb ...`, at most 72 characters, no dot at the end."""
import os
import re
import sys

sys.dont_write_bytecode = True
from lib import house

LENGTH = 72
SUBJECT = re.compile(r"[A-Za-z0-9_.][A-Za-z0-9_.,/*+{} -]*: [a-z]")
KINDS = re.compile(r"(feat|fix|chore|refactor|perf|style|revert)(\(.*\))?!?: ")


def judge(subject):
    if len(subject) > LENGTH:
        return f"{len(subject)} characters; at most {LENGTH}"
    if KINDS.match(subject):
        return "begin with the place that changed, not with the kind of change"
    if not SUBJECT.match(subject):
        return "write `area/file: lower-case verb ...`"
    if subject.endswith("."):
        return "no dot at the end"
    return None


def main():
    top = house.root()
    if not os.path.exists(os.path.join(top, ".git")):
        house.skip("not a git checkout")
    git = ["git", "-c", f"safe.directory={top}", "-C", top]
    status, text = house.run([*git, "log", "--no-merges", "--format=%h %s", "HEAD"])
    if status != 0:
        house.skip(f"git log: {text.strip()}")
    subjects = [line.partition(" ") for line in text.splitlines()]
    offences = [f"{commit} {subject}: {why}" for commit, _, subject in subjects
                if (why := judge(subject))]
    house.finish("commits", len(subjects), offences)


main()
