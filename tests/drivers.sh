#!/usr/bin/env bash
# Every scene of scenes/ on every driver: a table of the pixels that differ from the CPU's, 48 x 48, one sample a pixel.
#
#     tests/drivers.sh MANIFEST...
#     tests/drivers.sh /usr/share/vulkan/icd.d/lvp_icd.x86_64.json /opt/trixie:/usr/share/vulkan/icd.d/lvp_icd.json
#
# A MANIFEST is the JSON file of a Vulkan driver. FOLDER:MANIFEST is one of another system, which lies in FOLDER as debootstrap
# makes it; this needs root. GONIO names the program (target/release/gonio), SCENES other scenes. Prints what `gonio devices`
# says of each driver first. The exit code is 1 if a pixel differs or a driver is not exact. A slow software device takes
# a quarter of an hour for all scenes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
program=$(realpath "${GONIO:-target/release/gonio}")
read -r -a scenes <<<"${SCENES:-$(echo scenes/*.toml scenes/*/*.toml)}"
[ $# -gt 0 ] || { echo "usage: tests/drivers.sh MANIFEST..." >&2; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work" "${copies[@]}"' EXIT
copies=()

# on DRIVER COMMAND...: gonio on that driver alone.
on() {
    local driver=$1; shift
    case $driver in
    *:*)
        local root=${driver%%:*}
        chroot "$root" env -C /tmp/gonio-drivers VK_DRIVER_FILES="${driver#*:}" HOME=/tmp/gonio-drivers ./gonio "$@" ;;
    *) VK_DRIVER_FILES=$driver "$program" "$@" ;;
    esac
}

code=0 number=0
for driver in "$@"; do
    number=$((number + 1))
    case $driver in *:*)
        copy=${driver%%:*}/tmp/gonio-drivers
        rm -rf "$copy"; mkdir -p "$copy"; copies+=("$copy")
        cp "$program" "$copy/gonio"; cp -r scenes "$copy/" ;;
    esac
    echo "== $number: $driver"
    on "$driver" devices | tee "$work/devices"
    # The driver's devices are all rows but the first and the CPU backend's.
    awk '/^[0-9]/ && !/yes +yes *$/ { bad = 1 } /^[0-9]/ { any = 1 } END { exit bad || !any }' "$work/devices" || code=1
    # Scene by scene: one that a driver cannot do costs the others nothing.
    for scene in "${scenes[@]}"; do
        ended=0
        on "$driver" parity "$scene" --size 48x48 --spp 1 --between cpu,vulkan >"$work/said" 2>"$work/error" || ended=$?
        sed -nE 's/^(.*): ([0-9]+) of [0-9]+ pixels? differ.*/\1\t\2/p' "$work/said" >"$work/rows"
        case $ended in
        0) ;;
        # The scene's own files are not here (the kitchen's mesh).
        74) printf '%s\t-\n' "$scene" >>"$work/rows" ;;
        *) code=1; head -n 1 "$work/error"; [ -s "$work/rows" ] || printf '%s\texit %s\n' "$scene" "$ended" >>"$work/rows" ;;
        esac
        cat "$work/rows" >>"$work/$number"
    done
done

echo "== pixels that differ"
awk -F '\t' -v drivers=$number '
    { if (!($1 in seen)) { seen[$1] = 1; order[++rows] = $1 } cell[$1, FILENAME] = $2; files[FILENAME] = 1
      if ($2 + 0 > 0) differ += $2; compared += $2 ~ /^[0-9]+$/ }
    END {
        printf "%-72s", "scene"; for (d = 1; d <= drivers; d++) printf " %8d", d; print ""
        for (r = 1; r <= rows; r++) {
            printf "%-72s", order[r]
            for (d = 1; d <= drivers; d++) printf " %8s", cell[order[r], ARGV[d]]
            print ""
        }
        printf "%d pictures compared, %d pixels differ\n", compared, differ
    }' $(for at in $(seq "$number"); do echo "$work/$at"; done)
exit $code
