#!/usr/bin/env bash
# Builds walpha.html, the page that computes: scripts/web.sh [OUTPUT, by default target/web/walpha.html]
# Before, it sees that the page of `walpha view`, which is kept in the repository, is what its sources make.
#
# Needs Rust by rustup, Python, Node and npm. Ends with 77 where these, or the packages that the page is bundled
# from, cannot be had.
set -euo pipefail
cd "$(dirname "$0")/.."

output=${1:-target/web/walpha.html}
cannot() { echo "the page is not built: $1" && exit 77; }

{ command -v rustup && rustup target add wasm32-wasip1; } > /dev/null 2>&1 || cannot "the target wasm32-wasip1 cannot be had"
command -v npm > /dev/null || cannot "there is no npm"
command -v python3 > /dev/null || cannot "there is no Python"
if ! (cd web/page && npm ci --ignore-scripts --silent); then
  # Where packages can be had, something else is wrong.
  if npm view three version > /dev/null 2>&1; then exit 1; fi
  cannot "the packages in web/page/package.json cannot be had"
fi

kept=crates/render/src/view/page.html
made=$(mktemp)
notices=$(mktemp)
trap 'rm -f "$made" "$notices"' EXIT
node web/page/build.mjs view "$made"
cmp "$made" $kept || { echo "$kept is not what web/page makes: node web/page/build.mjs view $kept" && exit 1; }

# The notices are of all that Cargo.lock names.
cargo fetch --locked
CARGO_ENCODED_RUSTFLAGS="--remap-path-prefix=$PWD=walpha"$'\x1f'"--remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}=cargo" \
  cargo build --locked --profile web --target wasm32-wasip1 -p walpha-web
mkdir -p "$(dirname "$output")"
python3 scripts/third_party.py -p walpha-web --target wasm32-wasip1 > "$notices"
node web/page/build.mjs computes "$output" "${CARGO_TARGET_DIR:-target}/wasm32-wasip1/web/walpha_web.wasm" "$notices"
ls -l "$output"
