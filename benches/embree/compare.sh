#!/bin/sh
# Embree and obvhs against gonio, on the same rays, taking turns, so that a machine that grows slower is unfair to none.
#
#   benches/embree/compare.sh SCENE...
#
# ROUNDS (5), RAYS (1000000) and WORK (a folder, temporary if not given) may be set. Every round runs each tracer once after
# one warm-up; printed are the medians over the rounds, and the medians of the ratios within a round. Rows of rays are in
# Mrays/s; the row "build" is in builds a second: gonio's whole bake, Embree's commit at high quality, obvhs's wide tree.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$here/../..
rounds=${ROUNDS:-5}
rays=${RAYS:-1000000}
if [ -z "${WORK:-}" ]; then
    WORK=$(mktemp -d)
    trap 'rm -rf "$WORK"' EXIT
fi
mkdir -p "$WORK"
[ $# -gt 0 ] || set -- terrain:200k teapots:200k hairball:200k

make -C "$here" >&2
cargo build --release --manifest-path "$root/Cargo.toml" >&2
cargo bench --no-run --bench obvhs --manifest-path "$root/Cargo.toml" >&2
gonio=${CARGO_TARGET_DIR:-$root/target}/release/gonio
kinds=primary,diffuse,second,occlusion,shadow
: > "$WORK/rates"

round=1
while [ "$round" -le "$rounds" ]; do
    echo "round $round of $rounds" >&2
    for scene in "$@"; do
        name=$(basename "$scene" | sed 's/\.[^.]*$//; s/:/-/g')
        export=
        [ "$round" -gt 1 ] || export="--export-rays $WORK"
        # shellcheck disable=SC2086 # two words or none
        "$gonio" bench "$scene" --rays "$rays" --runs 1 --warmup 1 --only "$kinds" $export > "$WORK/table"
        grep -q '^  hits: equal$' "$WORK/table" || { cat "$WORK/table" >&2; exit 1; }
        # The table's rows: "  primary    1,000 rays", then "    cpu  median 1.23 Mrays/s".
        awk -v scene="$name" '
            /^  [a-z]+ .* rays, / { kind = $1 }
            /^    [^ ]+ +median / { print scene "\t" kind "\tgonio " $1 "\t" $3 }
            $1 == "load" && $4 == "bake" && $5 > 0 { print scene "\tbuild\tgonio cpu\t" 1 / $5 }
        ' "$WORK/table" >> "$WORK/rates.new"
        "$here/embree" --runs 1 --warmup 1 "$WORK/$name" >> "$WORK/rates.new" 2> "$WORK/said" \
            || { cat "$WORK/said" >&2; exit 1; }
        cargo bench -q --bench obvhs --manifest-path "$root/Cargo.toml" -- --runs 1 --warmup 1 "$WORK/$name" \
            >> "$WORK/rates.new" 2>> "$WORK/said" || { cat "$WORK/said" >&2; exit 1; }
        cat "$WORK/said" >&2
        # "scene: tracer: build 1.23 s".
        awk -F ': ' '/: build / { split($3, words, " "); if (words[2] > 0) print $1 "\tbuild\t" $2 "\t" 1 / words[2] }' \
            "$WORK/said" >> "$WORK/rates.new"
    done
    sed "s/^/$round\t/" "$WORK/rates.new" >> "$WORK/rates"
    rm "$WORK/rates.new"
    round=$((round + 1))
done

# round, scene, kind, tracer, rate
sort -s -t '	' -k2,2 "$WORK/rates" | awk -F '\t' '
    function median(list, n,    i, j, t, a) {
        split(list, a, " ")
        for (i = 2; i <= n; i++) for (j = i; j > 1 && a[j] + 0 < a[j - 1] + 0; j--) { t = a[j]; a[j] = a[j - 1]; a[j - 1] = t }
        return n % 2 ? a[(n + 1) / 2] : (a[n / 2] + a[n / 2 + 1]) / 2
    }
    {
        row = $2 "\t" $3
        if (!(row in seen)) { seen[row] = 1; rows[++row_count] = row }
        if (!($4 in known)) { known[$4] = 1; tracers[++tracer_count] = $4 }
        rate[row, $4, $1] = $5
        if ($1 > rounds) rounds = $1
    }
    function number(x) { return sprintf(x < 1 ? "%.3f" : "%.2f", x) }
    function ratio(row, over, under,    i, n, list) {
        for (i = 1; i <= rounds; i++) if ((row, over, i) in rate && (row, under, i) in rate && rate[row, under, i] > 0) {
            list = list " " rate[row, over, i] / rate[row, under, i]
            n++
        }
        return n ? sprintf("%.3f", median(list, n)) : "-"
    }
    END {
        printf "scene\trays"
        for (t = 1; t <= tracer_count; t++) printf "\t%s", tracers[t]
        print "\tvulkan/robust\tvulkan/fast\tcpu/obvhs\tcpu/robust"
        for (r = 1; r <= row_count; r++) {
            row = rows[r]
            printf "%s", row
            for (t = 1; t <= tracer_count; t++) {
                list = ""; n = 0
                for (i = 1; i <= rounds; i++) if ((row, tracers[t], i) in rate) { list = list " " rate[row, tracers[t], i]; n++ }
                printf "\t%s", n ? number(median(list, n)) : "-"
            }
            print "\t" ratio(row, "gonio vulkan", "embree robust") "\t" ratio(row, "gonio vulkan", "embree fast") \
                "\t" ratio(row, "gonio cpu", "obvhs") "\t" ratio(row, "gonio cpu", "embree robust")
        }
    }
'
