#!/usr/bin/env python3
"""Checks one rule of the tree, or all. usage: check_tree.py ROOT [RULE...]; exits 1 and lists the offences when there are any."""

import sys

import checks
from tree import Tree


def main():
    tree = Tree(sys.argv[1])
    offences = [sentence for rule in sys.argv[2:] or checks.ALL for sentence in checks.ALL[rule](tree)]
    print("\n".join(offences))
    return 1 if offences else 0


if __name__ == "__main__":
    sys.exit(main())
