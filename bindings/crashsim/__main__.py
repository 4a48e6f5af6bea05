"""`python -m crashsim report DIR [-o FILE]`: reports from the command line.

Exit codes: 0 done, 2 you can fix it, 4 the machine failed, 130 interrupted.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from crashsim._report import report

DONE, BAD_INPUT, MACHINE_FAILED, INTERRUPTED = 0, 2, 4, 130


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m crashsim", description="Reports of crashsim's results.")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    command = commands.add_parser(
        "report",
        help="write the HTML report of a case directory, or compare several",
        description="Writes one HTML file that needs no network, from the files that `crashsim run` wrote.",
    )
    command.add_argument("directory", metavar="DIR", help="case directory, or a directory of case directories")
    command.add_argument("-o", "--output", metavar="FILE", help="file to write (default: DIR/report.html)")
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs a command and returns its exit code. SystemExit with code 2 on wrong usage."""
    options = _parser().parse_args(arguments)
    try:
        print(report(options.directory, options.output))
    except (ValueError, ImportError) as error:
        return _fail(error, BAD_INPUT)
    except OSError as error:
        return _fail(error, MACHINE_FAILED)
    except KeyboardInterrupt:
        return INTERRUPTED
    return DONE


def _fail(error: Exception, code: int) -> int:
    print(f"error: {error}", file=sys.stderr)
    return code


if __name__ == "__main__":
    sys.exit(main())
