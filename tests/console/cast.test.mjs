// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import fs from "node:fs";
import test from "node:test";
import { count_at, counts_left, measure_beat } from "../../app/cast/web/src/counts.ts";
import { now_of, with_way } from "../../app/cast/web/src/part.ts";
import { catalogue } from "../../app/cast/web/src/words.ts";

const web = `${process.env.FOOTLIGHT_WEB}/../../cast/web`;
const music = { tempo: [{ count: 1, time_s: 0, bpm: 120 }, { count: 9, time_s: 4, bpm: 60 }], meter: [{ count: 3, beats: 4 }, { count: 11, beats: 3 }] };
const place = (from_s, until_s, cell) => ({ from_s, until_s, cell, count: "", measure: "", place: "", stay: "", way: `from ${cell}`, beside: "" });

test("counts follow every change of tempo", () => {
  assert.equal(count_at(music, 0), 1);
  assert.equal(count_at(music, 4), 9);
  assert.equal(count_at(music, 6), 11);
  assert.equal(count_at(music, -1), -1);
});

test("measures follow every change of meter, and a pickup", () => {
  assert.equal(measure_beat(music, 3), "1:1");
  assert.equal(measure_beat(music, 10), "2:4");
  assert.equal(measure_beat(music, 11), "3:1");
  assert.equal(measure_beat(music, 14), "4:1");
  assert.equal(measure_beat(music, 2), "0:4");
});

test("a count-down is 1 on the last count and 0 when the moment has come", () => {
  assert.equal(counts_left(music, 0, 2), 4);
  assert.equal(counts_left(music, 1.9, 2), 1);
  assert.equal(counts_left(music, 2, 2), 0);
  assert.equal(counts_left(music, 3, 2), 0);
});

test("she stands until she leaves, walks until she is there, and stays at the end", () => {
  const places = [place(0, 5, 1), place(8, 8, 2), place(10, 20, 3)];
  assert.deepEqual([now_of(places, -1).walks, now_of(places, -1).here.cell, now_of(places, 4).change_s], [false, 1, 5]);
  assert.deepEqual([now_of(places, 6).walks, now_of(places, 6).next.cell, now_of(places, 6).change_s], [true, 2, 8]);
  assert.deepEqual([now_of(places, 9).walks, now_of(places, 9).next.cell], [true, 3]);
  assert.deepEqual([now_of(places, 12).walks, now_of(places, 99).next], [false, undefined]);
  assert.equal(now_of([], 1), undefined);
});

test("a way in leads into her own places", () => {
  const own = [place(0, 5, 1), place(8, 30, 2), place(40, 60, 3)];
  const joined = with_way(own, [place(10, 12, 7), place(16, 16, 2)]);
  assert.deepEqual(joined.map((one) => [one.cell, one.from_s, one.until_s]), [[7, 10, 12], [2, 16, 30], [3, 40, 60]]);
  assert.equal(joined[1].way, "from 2");
  const later = with_way(own, [place(10, 12, 7), place(40, 40, 3)]);
  assert.deepEqual(later.map((one) => one.cell), [7, 3]);
});

test("both languages have a text for every word, with the same places, and the page's words are among them", () => {
  const places = (text) => [...text.matchAll(/\{(\w+)\}/g)].map((found) => found[1]).sort();
  for (const [word, [english, chinese]] of Object.entries(catalogue())) {
    assert.ok(english && chinese, word);
    assert.deepEqual(places(english), places(chinese), word);
  }
  const page = fs.readFileSync(`${web}/index.html`, "utf8");
  for (const found of page.matchAll(/data-(?:word|hint)="(\w+)"/g)) assert.ok(found[1] in catalogue(), found[1]);
});

test("nothing of a show is put into HTML, and nothing but a hello, a ping and questions leaves the page", () => {
  for (const name of fs.readdirSync(`${web}/src`)) {
    const source = fs.readFileSync(`${web}/src/${name}`, "utf8");
    assert.doesNotMatch(source, /innerHTML|outerHTML|insertAdjacentHTML|document\.write|eval\(/, name);
    assert.doesNotMatch(source, /order|seat|acknowledge/, name);
  }
});
