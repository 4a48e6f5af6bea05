"""Prints the variables of a LS-DYNA binout as lasso-python's LSDA reader finds them.

One line a channel: its id as crashsim makes it, a tab, and its values as the hexadecimal bytes of doubles, most
significant first. The times of a database "nodout" have the id "nodout/time".
"""

import struct
import sys

from lasso.dyna.lsda_py3 import Lsda


def children(directory):
    """Children by name; variables have theirs as bytes, directories as text."""
    return {n.decode() if isinstance(n, bytes) else n: c for n, c in directory.children.items()}


def is_state(name, child):
    return child.type == 0 and name[:1] == "d" and name[1:].isdigit()


def print_database(path, found):
    metadata = children(found["metadata"]) if "metadata" in found else {}
    ids = metadata["ids"].read() if "ids" in metadata else ()
    database = "rwforc" if path == "rwforc/forces" else path
    channels = {}
    for name in sorted(n for n, c in found.items() if is_state(n, c)):
        for variable, symbol in children(found[name]).items():
            values = symbol.read()
            named = len(values) == len(ids) and variable not in ("time", "cycle")
            for column, value in enumerate(values):
                middle = f"{ids[column]}/" if named else ""
                if (path, variable) == ("glstat", "stonewall_energy"):
                    middle = f"{column + 1}/"  # its walls have no ids
                channels.setdefault(f"{database}/{middle}{variable}", []).append(value)
    for channel, values in channels.items():
        print(channel, " ".join(struct.pack(">d", float(v)).hex() for v in values), sep="\t")


def walk(path, directory):
    found = children(directory)
    if any(is_state(n, c) for n, c in found.items()):
        print_database(path, found)
    for name, child in found.items():
        if child.type == 0 and name != "metadata" and not is_state(name, child):
            walk(f"{path}/{name}" if path else name, child)


lsda = Lsda(sys.argv[1], "r")  # closes its files when it goes
walk("", lsda.root)
