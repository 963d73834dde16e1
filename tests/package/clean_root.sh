#!/bin/sh
# clean_root.sh PACKAGE.deb FOLDER: makes the smallest Debian there is under FOLDER, installs the
# package in it, uses program, examples and Python module, and removes it again. As root.
set -eu
package=$1
root=$2/root

# shellcheck disable=SC2016  # apt's own variables
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Codename: bookworm' |
  head -n 1)
rm -rf --one-file-system "$root"
mkdir -p "$root"
debootstrap --variant=minbase bookworm "$root" "${mirror:-http://deb.debian.org/debian}" >&2
cp "$package" "$root/slideway.deb"
if [ -e /etc/resolv.conf ]; then cp -L /etc/resolv.conf "$root/etc/resolv.conf"; fi

inside() { env -u SLIDEWAY_DATA LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive chroot "$root" "$@"; }
say() { printf '\n== in the clean root: %s\n' "$*" >&2; }

say "apt-get install ./slideway.deb"
inside apt-get install -q -y --no-install-recommends ./slideway.deb >&2
inside dpkg -L slideway >"$2/files"

say "slideway identify, on an example"
inside slideway --version
inside sh -c 'cd /usr/share/doc/slideway/examples &&
  slideway identify problems/three-levels/problem.toml --json /tmp/report.json'

say "import slideway"
inside python3 -c '
import json, slideway
report = slideway.identify("/usr/share/doc/slideway/examples/problems/three-levels/problem.toml")
program = json.load(open("/tmp/report.json"))
for ours, theirs in zip(report.final.parameters, program["final"]["parameters"], strict=True):
    assert (ours.name, ours.value) == (theirs["name"], theirs["value"])
print(slideway.__version__, report.trace.verdict)'

say "man page and completions, those that are there"
grep -E '/(man1|completions|vendor-completions)/[^/]+$' "$2/files" | while read -r file; do
  inside test -s "$file"
  echo "$file"
done

say "apt-get remove slideway"
inside apt-get purge -q -y slideway >&2
grep -E '/.*slideway' "$2/files" | while read -r file; do
  [ ! -e "$root$file" ] || { echo "left behind: $file" >&2; exit 1; }
done
rm -rf --one-file-system "$root"
