// Writes the bundle of the page into ../static: the same sources and versions give the same bytes, wherever they lie.
import { createHash } from "node:crypto";
import { readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? join(here, "..", "static");
const pin = JSON.parse(readFileSync(join(here, "package.json"), "utf8")).devDependencies;

const result = await build({
  absWorkingDir: here,
  entryPoints: { viewer: "src/main.ts" },
  outdir: "out",
  write: false,
  bundle: true,
  minify: true,
  format: "iife",
  target: ["chrome111", "firefox114", "safari16.4"],
  charset: "utf8",
  legalComments: "none",
  logLevel: "warning",
});

const texts = Object.fromEntries(result.outputFiles.map((file) => [file.path.endsWith(".css") ? "viewer.css" : "viewer.js", file.text]));

// Both texts stand inside a page: what a reader of HTML takes for the end of a script must not occur in them.
for (const [name, text] of Object.entries(texts)) {
  const found = /<\/(?:script|style)|<!--|<script/i.exec(text);
  if (found) throw new Error(`${name} holds ${found[0]}: it would end the page that carries it`);
}

const licence = (name) =>
  `${name} ${pin[name]}\n\n${readFileSync(join(here, "node_modules", name, "LICENSE"), "utf8").trim()}\n`;
texts["THIRD_PARTY.txt"] = ["three", "uplot"].map(licence).join(`\n${"-".repeat(80)}\n\n`);
texts["page.html"] = readFileSync(join(here, "src", "page.html"), "utf8");

const names = Object.keys(texts).sort();
const sum = (text) => createHash("sha256").update(text, "utf8").digest("hex");
texts["SHA256SUMS"] = names.map((name) => `${sum(texts[name])}  ${name}\n`).join("");
for (const [name, text] of Object.entries(texts)) writeFileSync(join(out, name), text);
