"""`python -m benchmarks` is `gt-env`."""

import sys


def main() -> None:
    """Run the command line; Ctrl-C is answered in one line also while packages are being imported."""
    try:
        from benchmarks.cli import run  # takes most of a second

        status = run(sys.argv[1:])
    except KeyboardInterrupt:
        print("gt-env: interrupted", file=sys.stderr)
        status = 130
    sys.exit(status)


if __name__ == "__main__":
    main()
