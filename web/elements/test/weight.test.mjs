// What a page downloads for labs: the one file.
import assert from "node:assert/strict";
import { readFileSync, statSync } from "node:fs";
import test from "node:test";
import { gzipSync } from "node:zlib";

const at = (path) => new URL(path, import.meta.url);
/** A module without optimization, as `LABSPEC_PROFILE=quick` builds it, is larger than this, bytes. */
const OPTIMIZED = 4_000_000;
const isQuick = statSync(at("../../labspec/generated/player/labspec_bg.wasm")).size > OPTIMIZED;

test("the one file has at most a million bytes by gzip", { skip: isQuick && "the module is not optimized" }, () => {
  const size = gzipSync(readFileSync(at("../dist/labspec-elements.js")), { level: 9 }).length;
  assert.ok(size <= 1_000_000, `${size} bytes`);
});
