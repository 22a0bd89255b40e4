#!/usr/bin/env bash
# Builds the npm package in npm/, and tests it in Node, from a bundle, and by the TypeScript compiler: scripts/npm.sh [FOLDER for the packed file]
#
# Ends with 77 where Rust's target, Node or the packages of npm cannot be had.
set -euo pipefail
cd "$(dirname "$0")/.."

cannot() { echo "the npm package is not built: $1" && exit 77; }

{ command -v rustup && rustup target add wasm32-unknown-unknown; } > /dev/null 2>&1 || cannot "the target wasm32-unknown-unknown cannot be had"
command -v npm > /dev/null || cannot "there is no npm"
command -v python3 > /dev/null || cannot "there is no Python"

made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT
CARGO_ENCODED_RUSTFLAGS="--remap-path-prefix=$PWD=walpha"$'\x1f'"--remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}=cargo" \
  cargo build --locked --profile web --target wasm32-unknown-unknown -p walpha-npm
cp npm/{index.js,index.d.ts,package.json,README.md,LICENSE-APACHE,LICENSE-MIT} "$made"
python3 scripts/third_party.py -p walpha-npm --target wasm32-unknown-unknown > "$made/THIRD_PARTY.md"
# Text rather than a file beside it: bundlers need no setting for it.
{
  printf 'export const WASM = "'
  gzip -9 -n < "${CARGO_TARGET_DIR:-target}/wasm32-unknown-unknown/web/walpha_npm.wasm" | base64 -w 0
  printf '";\n'
} > "$made/wasm.js"
version=$(sed -n '/^\[workspace.package\]/,/^\[/s/^version = "\(.*\)"/\1/p' Cargo.toml)
grep -q "\"version\": \"$version\"" npm/package.json || { echo "npm/package.json is not of version $version"; exit 1; }
packed=$(cd "$made" && npm pack --silent)

# As a user installs it.
mkdir "$made/user"
cp npm/test.mjs "$made/user/test.mjs"
cd "$made/user"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund "../$packed" || cannot "npm cannot install a file"
node --test test.mjs
if npm install --silent --no-audit --no-fund esbuild typescript@5 @types/node@20; then
  npx esbuild test.mjs --bundle --platform=node --format=esm --minify --outfile=bundle.mjs --log-level=warning
  node --test bundle.mjs
  cat > types.mts << 'TS'
import { alphaShape, type AlphaShape } from "walpha";
const shape: AlphaShape = await alphaShape([[0, 0, 0], [1, 0, 0]], { radius: 1, weights: [0, 0] });
const flat: AlphaShape = await alphaShape(new Float64Array(6));
const ring: Uint32Array = flat.polygons[0]?.[0] ?? shape.boundary;
// @ts-expect-error a radius is a number
await alphaShape([[0, 0]], { radius: "1" });
console.log(ring, shape.volume + flat.area);
TS
  npx tsc --noEmit --strict --target es2022 --module nodenext --skipLibCheck types.mts
else
  echo "skipped: there are no bundler and no compiler of TypeScript"
fi
ls -l "$made/$packed"
if [ $# -gt 0 ]; then cp "$made/$packed" "$1"; fi
