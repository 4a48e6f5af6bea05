"""Prints as JSON what pyisomme reads: the channels of an ISO-MME test, or one channel file.

Usage: read_iso_mme.py FOLDER | CHANNEL_FILE
"""

import json
import logging
import math
import sys
from pathlib import Path

import pyisomme
from pyisomme.parsing import parse_xxx
from pyisomme.sources import read_text_with_fallback


def described(channel):
    values = [float(value) for value in channel.get_data()]
    return {
        "code": str(channel.code),
        "name": channel.get_info("Name of the channel"),
        "unit": str(channel.unit),
        "times": [float(time) for time in channel.data.index],
        "values": [None if math.isnan(value) else value for value in values],
    }


def main():
    logging.disable(logging.CRITICAL)
    path = Path(sys.argv[1])
    if path.is_dir():
        channels = pyisomme.Isomme().read(path).channels
    else:
        channels = [parse_xxx(read_text_with_fallback(path.read_bytes()))[0]]
    json.dump([described(channel) for channel in channels], sys.stdout)


main()
