#!/usr/bin/env bash
# palette (crate 0.7.6): a project that pins it exactly no longer compiles, because its own derive crate moved on.
#
# Expected: an exact version keeps building; crates made for each other name each other exactly. Source: The Cargo Book,
#   "Specifying Dependencies" (a plain version allows every compatible one) and "SemVer Compatibility": a patch release breaks
#   no user.
# Seen: palette 0.7.6 takes any palette_derive from 0.7.6 on. Since 0.7.7 the derived code names modules that only palette
#   0.7.7 has, and 34 errors arise inside palette itself. With palette_derive held at 0.7.6 too it builds.
# Hurts: whoever pins colours for reproducible pictures, without a lock file or in a library, cannot build at all.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cargo init --quiet --lib --name probe
printf 'palette = "=0.7.6"\n' >>Cargo.toml
alone=0
cargo check --quiet 2>errors || alone=$?
printf 'palette_derive = "=0.7.6"\n' >>Cargo.toml
held=0
cargo check --quiet 2>/dev/null || held=$?
echo "palette =0.7.6 alone: exit code $alone; $(grep 'could not compile' errors || true)"
echo "with palette_derive =0.7.6: exit code $held"
if ((alone == 101 && held == 0)) && grep -q 'could not compile `palette`' errors; then
    echo "as described"
else
    echo "CHANGED: palette 0.7.6 builds alone, or not even with its own derive crate"
    exit 1
fi
