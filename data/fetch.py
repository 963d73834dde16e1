#!/usr/bin/python3
"""fetch.py DIR [--list sources.tsv]: the public measured data that tests and problems use.

Each line of the list is a file of DIR, its SHA-256, how it is made, and the addresses for it:
  copy      the file, byte for byte
  test_bar  rows made from the two logs of the indicators on the test bar
  level     station readings from the log of an electronic level
  by_hand   typed in or converted by hand from what is there: cannot be fetched
The SHA-256 of `copy` is that of the file; of the others, of its lines that are not comments. A file
that is there and right is left alone. Exit code 1 if one of them could not be had.
"""

import argparse
import hashlib
import struct
import sys
import urllib.request
from collections.abc import Callable
from http.client import HTTPException
from pathlib import Path

TIMEOUT = 60.0  # seconds without a byte


def test_bar(logs: list[bytes]) -> bytes:
    """Rows of two logs of pairs of float64, UNIX time and reading in mm: of the bar, of the feed."""
    bar, feed = (list(struct.iter_unpack("<dd", log)) for log in logs)
    begin = bar[0][0]
    rows = ["index,t712_s,bar_mm,t710_s,zind_mm"]
    rows += [f"{i},{t - begin:.4f},{mm:.4f},{u - begin:.4f},{feed_mm:.4f}"
             for i, ((t, mm), (u, feed_mm)) in enumerate(zip(bar, feed))]
    return "\n".join([*rows, ""]).encode()


def level(logs: list[bytes]) -> bytes:
    """Station readings of a log of 17-byte records: time, two angles of 28 bits, trigger."""
    def mm_per_m(word: int) -> float:
        shifted = (word & 0xFFFFFFE) << 4
        return 1000 * (shifted - ((shifted & 0x80000000) << 1)) / 2**28
    records = list(struct.iter_unpack("<dIIB", logs[0]))
    begin = records[0][0]
    rows = ["station,t_s,x_origin_mm,raw_x_mm_per_m,raw_y_mm_per_m"]
    for station, (t, x, y, _) in enumerate((r for r in records if r[3]), start=1):
        rows.append(f"{station},{t - begin:.3f},{1000 - 20 * (station - 1):.1f},"
                    f"{mm_per_m(x):.5f},{mm_per_m(y):.5f}")
    return "\n".join([*rows, ""]).encode()


MAKERS: dict[str, Callable[[list[bytes]], bytes]] = {
    "copy": lambda parts: parts[0], "test_bar": test_bar, "level": level}


def checksum(content: bytes, how: str) -> str:
    if how != "copy":
        lines = content.splitlines(keepends=True)
        content = b"".join(line for line in lines if not line.startswith(b"#"))
    return hashlib.sha256(content).hexdigest()


def download(address: str) -> bytes:
    with urllib.request.urlopen(address, timeout=TIMEOUT) as answer:
        return bytes(answer.read())


def fetch(path: Path, wanted: str, how: str, addresses: list[str]) -> str:
    """Empty if the file is there and right in the end, else why it is not."""
    if path.exists() and checksum(path.read_bytes(), how) == wanted:
        return ""
    if how == "by_hand":
        return "made by hand from " + " ".join(addresses)
    try:
        content = MAKERS[how]([download(address) for address in addresses])
    except (OSError, HTTPException, ValueError, struct.error, IndexError) as fault:
        return f"{' '.join(addresses)}: {fault}"
    found = checksum(content, how)
    if found != wanted:
        return f"{' '.join(addresses)}: SHA-256 {found} is not {wanted}"
    if how != "copy":
        content = f"# Made by data/fetch.py from {' '.join(addresses)}\n".encode() + content
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(path.name + ".part")
    part.write_bytes(content)
    part.replace(path)
    return ""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--list", type=Path, default=Path(__file__).with_name("sources.tsv"))
    options = parser.parse_args()
    lines = options.list.read_text(encoding="utf-8").splitlines()
    entries = [line.split("\t") for line in lines if line and not line.startswith("#")]
    missing = 0
    for name, wanted, how, *addresses in entries:
        why = fetch(options.folder / name, wanted, how, addresses)
        if why:
            missing += 1
            print(f"could not be had: {name}: {why}", file=sys.stderr)
    print(f"{len(entries) - missing} of {len(entries)} files are in {options.folder}")
    sys.exit(1 if missing else 0)


if __name__ == "__main__":
    main()
