// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import fs from "node:fs";
import test from "node:test";
import { catalogue, say, set_language } from "../../app/console/web/src/words.ts";

const web = process.env.FOOTLIGHT_WEB;
const page = fs.readFileSync(`${web}/index.html`, "utf8");
const sources = fs.readdirSync(`${web}/src`).map((name) => [name, fs.readFileSync(`${web}/src/${name}`, "utf8")]);
const places = (text) => [...text.matchAll(/\{(\w+)\}/g)].map((found) => found[1]).sort();

test("both languages have a text for every word, with the same places", () => {
  for (const [word, [english, chinese]] of Object.entries(catalogue())) {
    assert.ok(english && chinese, word);
    assert.deepEqual(places(english), places(chinese), word);
  }
});

test("places are filled, in the language that was chosen", () => {
  assert.equal(say("refused", { order: "go", why: "too soon" }), "go refused: too soon");
  set_language("zh");
  assert.equal(say("refused", { order: "go", why: "too soon" }), "go 被拒绝：too soon");
  set_language("en");
  assert.equal(say("refused", { order: "{why}", why: "x" }), "{why} refused: x", "what is filled in is not filled again");
});

test("every word of the page is in the catalogue", () => {
  for (const found of page.matchAll(/data-(?:word|name|hint)="(\w+)"/g)) assert.ok(found[1] in catalogue(), found[1]);
});

test("every part that the program asks for is on the page", () => {
  for (const [name, text] of sources) {
    for (const found of text.matchAll(/by_id(?:<\w+>)?\("(\w+)"\)/g)) assert.ok(page.includes(`id="${found[1]}"`), `${name}: #${found[1]}`);
  }
});

test("nothing of a show can become HTML, script or style, and nothing comes from elsewhere", () => {
  for (const [name, text] of sources) {
    assert.doesNotMatch(text, /innerHTML|outerHTML|insertAdjacentHTML|document\.write|\beval\(|new Function|\.srcdoc/, name);
    assert.doesNotMatch(text.replace(/\/\/.*|http:\/\/www\.w3\.org\S*/g, ""), /https?:\/\//, name);
  }
  assert.doesNotMatch(page, /\sstyle=|\son\w+=|<script>|<style>|https?:/);
});

test("every button and field has a name", () => {
  for (const found of page.matchAll(/<(button|input|canvas)\b([^>]*)>(.*)/g)) {
    const named = /data-(word|name)=/.test(found[2]) || /aria-(hidden|labelledby)/.test(found[2]) || /data-word=/.test(found[3]);
    assert.ok(named, found[0].slice(0, 80));
  }
});
