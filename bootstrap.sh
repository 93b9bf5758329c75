#!/usr/bin/env bash
# Prepares a bare Debian or Ubuntu for building and running gonio, then runs its arguments:
#
#     ./bootstrap.sh cargo run --release -- render scenes/first-light.toml -o first-light.png
#
# It installs only what is missing (Vulkan loader; a software driver if there is no driver at all; the shaderc
# library and a C++ compiler for the build), says what it does, and does nothing when there is nothing to do.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
archive=$root/.cargo/shaderc/libshaderc_combined.a

say() { echo "bootstrap: $*" >&2; }
fail() { say "$*"; exit 1; }

library() { ldconfig -p 2>/dev/null | grep -q "$1" || compgen -G "/usr/lib/*/$1*" >/dev/null; }
driver() {
    [ -n "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] && return
    local folder
    for folder in /usr/share/vulkan/icd.d /etc/vulkan/icd.d /usr/local/share/vulkan/icd.d "${XDG_DATA_HOME:-${HOME:-/root}/.local/share}/vulkan/icd.d"; do
        compgen -G "$folder/*.json" >/dev/null && return
    done
    return 1
}

missing=()
[ -e "$archive" ] || compgen -G "/usr/lib/*/libshaderc_combined.a" >/dev/null || missing+=(libshaderc-dev)
command -v g++ >/dev/null || command -v c++ >/dev/null || missing+=(g++)
library libvulkan.so.1 || missing+=(libvulkan1)
driver || missing+=(mesa-vulkan-drivers)

if [ ${#missing[@]} -gt 0 ]; then
    command -v apt-get >/dev/null || fail "this system lacks ${missing[*]} (Debian's names) and has no apt-get; install them and run this again"
    as_root=()
    if [ "$(id -u)" != 0 ]; then
        command -v sudo >/dev/null || fail "installing ${missing[*]} needs root: run this as root or install sudo"
        as_root=(sudo)
    fi
    say "installing ${missing[*]}"
    install=(env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}")
    if ! "${as_root[@]}" "${install[@]}" >/dev/null 2>&1; then
        "${as_root[@]}" apt-get update -qq || fail "apt-get update failed"
        "${as_root[@]}" "${install[@]}" >/dev/null || fail "apt-get could not install ${missing[*]}"
    fi
fi

# Debian's shaderc archive lacks the glslang and SPIR-V Tools it needs; one archive with all of them links.
if [ ! -e "$archive" ]; then
    say "merging shaderc's static archives into .cargo/shaderc"
    mkdir -p "$(dirname "$archive")"
    found=$(compgen -G "/usr/lib/*/libshaderc_combined.a" | head -n 1)
    [ -n "$found" ] || fail "libshaderc-dev is installed, but there is no libshaderc_combined.a"
    {
        echo "create $archive.new"
        for name in shaderc_combined glslang MachineIndependent GenericCodeGen OSDependent OGLCompiler SPIRV HLSL SPIRV-Tools-opt SPIRV-Tools; do
            [ -e "${found%/*}/lib$name.a" ] && echo "addlib ${found%/*}/lib$name.a"
        done
        echo save
        echo end
    } | ar -M
    mv "$archive.new" "$archive"
fi

[ $# -eq 0 ] || exec "$@"
