// Bundles a page into one file:
//
//   node build.mjs computes walpha.html walpha.wasm notices.md   the page that computes
//   node build.mjs view page.html                                the page of `walpha view`, without its title and its data

import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";

const [kind, output, wasm, notices] = process.argv.slice(2);
const here = new URL(".", import.meta.url).pathname;

// Top-level await needs a module; the page wraps it in an async function instead.
async function bundle(entry, wrap) {
  const { outputFiles: [{ text }] } = await build({
    entryPoints: [here + entry], bundle: true, minify: true, write: false, format: "esm", target: "es2022",
    legalComments: "inline", charset: "utf8",
  });
  // Nothing in a script may end its element.
  const inert = text.replaceAll("</script", "<\\/script");
  return wrap ? `(async () => {${inert}})();` : inert;
}

// The licences of packages that scripts are bundled from.
function licences(packages) {
  const { dependencies } = JSON.parse(readFileSync(here + "package.json", "utf8"));
  return packages.map((name) => {
    const folder = `${here}node_modules/${name}/`;
    const file = readdirSync(folder).find((file) => /^licen[cs]e(-mit)?(\..*)?$/i.test(file));
    return `## ${name} ${dependencies[name]}\n\n${readFileSync(folder + file, "utf8")}`;
  });
}

// What is packed differs from one version of zlib to the next, so it is only in what is not kept in the repository.
const packed = (bytes) => gzipSync(bytes, { level: 9 }).toString("base64");
const parts = { style: readFileSync(here + "page.css", "utf8").trimEnd() };
if (kind === "view") {
  parts.script = await bundle("view.js", true);
  parts.notices = licences(["three"]).join("\n");
} else {
  parts.worker = await bundle("worker.js", false);
  parts.script = await bundle("main.js", true);
  parts.wasm = packed(readFileSync(wasm));
  parts.notices = packed([readFileSync(notices, "utf8"), ...licences(["@bjorn3/browser_wasi_shim", "three"])].join("\n"));
}
// Sections of the other page go, and comments around those of this one.
const other = kind === "view" ? "computes" : "view";
const made = "<!-- Made by `node web/page/build.mjs` from web/page: change what is there. -->";
const page = readFileSync(here + "index.html", "utf8")
  .replace("<!DOCTYPE html>", `<!DOCTYPE html>${made}`)
  .replace(new RegExp(`<!--${other}-->\n.*?<!--/${other}-->\n`, "gs"), "")
  .replace(/<!--\/?(view|computes)-->\n/g, "")
  .replace("/*{style}*/", () => parts.style)
  .replace(/\{(wasm|notices|worker|script)\}/g, (_, name) => parts[name]);
writeFileSync(output, page);
