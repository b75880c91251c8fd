#!/usr/bin/env node
/** The program that mdBook starts: `mdbook-labspec supports RENDERER`, and a book on standard input. */
import { readFileSync } from "node:fs";
import { preprocess, supports } from "./mdbook.js";

function run(command: string | undefined, renderer: string | undefined): number {
  if (command === "supports") return supports(renderer ?? "") ? 0 : 1;
  try {
    const { book, messages } = preprocess(JSON.parse(readFileSync(0, "utf8")));
    for (const message of messages) process.stderr.write(`mdbook-labspec: ${message}\n`);
    process.stdout.write(JSON.stringify(book));
    return 0;
  } catch (e) {
    process.stderr.write(`mdbook-labspec: ${e instanceof Error ? e.message : String(e)}\n`);
    return 1;
  }
}

process.exitCode = run(process.argv[2], process.argv[3]);
