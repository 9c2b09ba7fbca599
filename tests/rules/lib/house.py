"""What the rules share: the files of the house, and how a rule ends."""
import os
import subprocess
import sys

SKIPPED = 77
CODE = (".c", ".h", ".cpp")


def root():
    if len(sys.argv) != 2:
        sys.exit(f"usage: {sys.argv[0]} SOURCE_FOLDER")
    return os.path.abspath(sys.argv[1])


def files(top, folder, endings=None):
    """Paths relative to `top` of the files below `folder`, sorted."""
    found = []
    for here, folders, names in os.walk(os.path.join(top, folder)):
        folders[:] = sorted(f for f in folders if f != "__pycache__")
        for name in names:
            if endings is None or name.endswith(endings):
                found.append(os.path.relpath(os.path.join(here, name), top))
    return sorted(found)


def content(top, path):
    with open(os.path.join(top, path), "rb") as f:
        return f.read()


def lines(top, path):
    with open(os.path.join(top, path), encoding="utf-8", errors="replace") as f:
        return f.read().splitlines()


def run(command, **options):
    """(exit status, stdout and stderr); the rule is skipped when the program is missing."""
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, errors="replace", check=False, **options)
    except FileNotFoundError:
        skip(f"{command[0]} is not installed")
    return done.returncode, done.stdout


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def finish(what, checked, offences):
    """Prints the offences; the exit status says whether there were any."""
    for offence in offences:
        print(offence)
    if not checked:
        print(f"{what}: found nothing to check, so something is wrong with the rule")
    print(f"{what}: {checked} checked, {len(offences)} against the rule")
    sys.exit(1 if offences or not checked else 0)
