#!/usr/bin/env bash
# The public items of each library, as api/ lists them for review: `scripts/check_api.sh` compares, `scripts/check_api.sh write`
# writes them anew. What differs is a change that users see, and belongs in CHANGELOG.md.
#
# Exit code 77 without cargo-public-api or a nightly toolchain, whose rustdoc it asks:
# cargo install --locked cargo-public-api && rustup toolchain install nightly --profile minimal
set -euo pipefail
cd "$(dirname "$0")/.."

if ! cargo public-api --version > /dev/null 2>&1 || ! cargo +nightly --version > /dev/null 2>&1; then
  echo "cargo-public-api or a nightly toolchain is missing"
  exit 77
fi
# Items of the standard library move between std, alloc and core, and between private modules, from one nightly to the next:
# of their paths the first module and the name are listed.
plain() { sed -E 's/\b(core|alloc|std)::([a-z0-9_]+)::([a-z0-9_]+::)*/std::\2::/g; s/std::rcs::/std::sync::/g'; }

listed=$(mktemp)
trap 'rm -f "$listed" "$listed.log"' EXIT
status=0
for library in balls base check complex files model points regular render shape volume; do
  # Without derived and blanket implementations. The target is its own, so that lints and tests stay built.
  CARGO_TARGET_DIR=target/api cargo public-api -p "walpha-$library" -sss 2> "$listed.log" | plain > "$listed" || { cat "$listed.log"; exit 1; }
  if [ "${1:-}" = write ]; then
    cp "$listed" "api/walpha-$library.txt"
  else
    diff -u "api/walpha-$library.txt" "$listed" || status=1
  fi
done
exit "$status"
