// Bundles the page into one file: node build.mjs walpha.wasm notices.md walpha.html

import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";

const [wasm, notices, output] = process.argv.slice(2);
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

// The notices of what is in the page: Rust's, and the packages that the scripts are bundled from.
function licences() {
  const { dependencies } = JSON.parse(readFileSync(here + "package.json", "utf8"));
  const texts = Object.entries(dependencies).map(([name, version]) => {
    const folder = `${here}node_modules/${name}/`;
    const file = readdirSync(folder).find((file) => /^licen[cs]e(-mit)?(\..*)?$/i.test(file));
    return `## ${name} ${version}\n\n${readFileSync(folder + file, "utf8")}`;
  });
  return [readFileSync(notices, "utf8"), ...texts].join("\n");
}

const packed = (bytes) => gzipSync(bytes, { level: 9 }).toString("base64");
const parts = {
  style: readFileSync(here + "page.css", "utf8"),
  worker: await bundle("worker.js", false),
  script: await bundle("main.js", true),
  wasm: packed(readFileSync(wasm)),
  notices: packed(licences()),
};
const page = readFileSync(here + "index.html", "utf8")
  .replace("/*{style}*/", () => parts.style)
  .replace(/\{(wasm|notices|worker|script)\}/g, (_, name) => parts[name]);
writeFileSync(output, page);
