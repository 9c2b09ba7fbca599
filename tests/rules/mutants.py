"""The solvers' deliberate faults are still ones that can be made, and their tests are there.
tests/mutants/run.py makes them."""
import sys

sys.dont_write_bytecode = True
from lib import house, mutants


def main():
    top = house.root()
    found, offences = mutants.read(top)
    house.finish("mutants", len(found), offences + list(mutants.find_offences(top, found)))


main()
