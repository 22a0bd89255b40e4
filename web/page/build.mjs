// Bundles the page into one file: node build.mjs walpha.wasm walpha.html

import { readFileSync, writeFileSync } from "node:fs";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";

const [wasm, output] = process.argv.slice(2);
const here = new URL(".", import.meta.url).pathname;

// Top-level await needs a module; the page wraps it in an async function instead.
async function bundle(entry, wrap) {
  const { outputFiles: [{ text }] } = await build({
    entryPoints: [here + entry], bundle: true, minify: true, write: false, format: "esm", target: "es2022",
    legalComments: "inline", loader: { ".toml": "text" }, charset: "utf8",
  });
  // Nothing in a script may end its element.
  const inert = text.replaceAll("</script", "<\\/script");
  return wrap ? `(async () => {${inert}})();` : inert;
}

const parts = {
  style: readFileSync(here + "page.css", "utf8"),
  worker: await bundle("worker.js", false),
  script: await bundle("main.js", true),
  wasm: gzipSync(readFileSync(wasm), { level: 9 }).toString("base64"),
};
const page = readFileSync(here + "index.html", "utf8")
  .replace("/*{style}*/", () => parts.style)
  .replace(/\{(wasm|worker|script)\}/g, (_, name) => parts[name]);
writeFileSync(output, page);
