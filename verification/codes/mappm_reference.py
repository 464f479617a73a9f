"""The serial program of MaPPM, written for clarity: the adapter of mappm-reference, which takes one core."""

import sys

from verification.codes.mappm import Solver
from verification.protocol.adapter import main

if __name__ == "__main__":
    sys.exit(main(Solver("mappm-reference", ("neighbours",), most_cores=1)))
