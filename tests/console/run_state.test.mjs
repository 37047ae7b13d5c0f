// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import test from "node:test";
import { card_of } from "../../app/console/web/src/desk_panel.ts";
import { edit_text } from "../../app/console/web/src/asked.ts";
import { many } from "../../app/console/web/src/find.ts";
import { is_muted } from "../../app/console/web/src/people_panel.ts";
import { kDrawnSilent, kDrawnWrong, kLayers, Layers, Nodes, switch_at } from "../../app/console/web/src/floor_state.ts";
import { Presses } from "../../app/console/web/src/keys.ts";
import { centres_of, decode_looks, decode_nodes, decode_plan } from "../../app/console/web/src/protocol.ts";
import { ShowClock } from "../../app/console/web/src/show_clock.ts";
import { fact_text, is_empty } from "../../app/console/web/src/facts.ts";
import { clock_text, count_text, countdown_text, timecode_text } from "../../app/console/web/src/time_text.ts";
import { count_at, span_of } from "../../app/console/web/src/timeline.ts";

test("times are cut, count-downs are rounded up", () => {
  assert.deepEqual([0, 59.99, 60, 83.57, 3599.99, 3600, -0.5].map(clock_text), ["0:00.0", "0:59.9", "1:00.0", "1:23.5", "59:59.9", "1:00:00.0", "−0:00.5"]);
  assert.deepEqual([-1, 0, 0.01, 3.4, 9.95, 10, 10.01, 59.2, 119.5, 120, 483].map(countdown_text), ["0.0", "0.0", "0.1", "3.4", "10.0", "10.0", "11", "60", "2:00", "2:00", "8:03"]);
  assert.deepEqual([[0, 25], [83.56, 25], [3661.999, 30]].map(([time, fps]) => timecode_text(time, fps)), ["00:00:00:00", "00:01:23:14", "01:01:01:29"]);
  assert.deepEqual([1, 17.29, 17.3].map(count_text), ["1", "17.2", "17.3"]);
  assert.equal(countdown_text(Infinity), "");
});

test("counts follow changes of tempo", () => {
  const tempo = [{ count: 1, time_s: 0, bpm: 120 }, { count: 21, time_s: 10, bpm: 60 }];
  assert.deepEqual([0, 5, 10, 12].map((time) => count_at(tempo, time)), [1, 11, 21, 23]);
  assert.deepEqual(span_of([{ from_s: 3, to_s: 9 }, { from_s: 9, to_s: 30 }]), { from_s: 3, to_s: 30 });
});

test("the clock goes on between messages, works jitter off and follows a jump at once", () => {
  const clock = new ShowClock();
  clock.tell({ position_s: 10, rate: 1, came_ms: 1000 });
  assert.equal(clock.at(1500), 10.5);
  clock.tell({ position_s: 10.6, rate: 1, came_ms: 1700 }); // 0.1 s behind what is shown
  assert.ok(Math.abs(clock.at(1700) - 10.7) < 1e-9, "no step back");
  assert.ok(Math.abs(clock.at(2200) - 11.1) < 1e-9, "right again half a second later");
  let last = 0;
  for (let now = 1700; now < 2300; now += 16) {
    assert.ok(clock.at(now) > last, "never back");
    last = clock.at(now);
  }
  clock.tell({ position_s: 30, rate: 1, came_ms: 2300 });
  assert.equal(clock.at(2300), 30);
  clock.tell({ position_s: 30.1, rate: 0, came_ms: 2500 });
  assert.equal(clock.at(9000), 30.1);
});

const bytes_of = (magic, ...words) => {
  const view = new DataView(new ArrayBuffer(4 + 4 * words.length));
  [...magic].forEach((letter, i) => view.setUint8(i, letter.charCodeAt(0)));
  words.forEach((word, i) => (typeof word === "string" ? view.setFloat32(4 + 4 * i, Number(word), true) : view.setUint32(4 + 4 * i, word, true)));
  return view.buffer;
};

test("a plan is decoded, and refused when it is not what it says", () => {
  const good = bytes_of("FLPM", 1, 9, 2, 3, 0, 2, 3, "0", "1.5", "0.25", 7, 8, 9);
  const { epoch, tracks } = decode_plan(good, 10);
  assert.equal(epoch, 9);
  assert.deepEqual([...tracks.starts], [0, 2, 3]);
  assert.deepEqual([...tracks.marks], [0, 7, 1500, 8, 250, 9]);
  assert.throws(() => decode_plan(good, 9), /cell 9 of 9/);
  assert.throws(() => decode_plan(good.slice(0, -4), 10), /not as long as it says/);
  assert.throws(() => decode_plan(good.slice(0, 8), 10), /cut off/);
  assert.throws(() => decode_plan(bytes_of("FLPX", 1), 10), /begins with "FLPX"/);
  assert.throws(() => decode_plan(bytes_of("FLPM", 2), 10), /version 2/);
  assert.throws(() => decode_plan(bytes_of("FLPM", 1, 9, 2, 3, 0, 3, 3, "0", "1", "2", 7, 8, 9), 10), /no marks/);
  assert.throws(() => decode_plan(new ArrayBuffer(0), 10), /begins with ""/);
});

test("looks and frames of nodes are decoded, other kinds of frames are left alone", () => {
  const looks = new Uint8Array(24 - 4 + 32);
  looks.set(new Uint8Array(bytes_of("FLLK", 1, 3, 5, 1)));
  looks[20 + 31] = 42;
  const decoded = decode_looks(looks.buffer);
  assert.deepEqual([decoded.epoch, decoded.index, decoded.looks.length, decoded.looks[31]], [3, 5, 32, 42]);
  assert.throws(() => decode_looks(looks.buffer.slice(0, 40)), /not as long/);
  const frame = new DataView(new ArrayBuffer(8 + 16));
  frame.setUint8(0, 1);
  frame.setUint8(1, 1);
  [1, 2, 3, 12, 1].forEach((word, i) => frame.setUint32(4 + 4 * i, word, true));
  assert.deepEqual(decode_nodes(frame.buffer), { all: true, runs: [{ first: 2, many: 3, index: 12, flags: 1 }] });
  frame.setUint32(4, 2, true);
  assert.throws(() => decode_nodes(frame.buffer), /not as long/);
  frame.setUint8(0, 77);
  assert.equal(decode_nodes(frame.buffer), undefined);
  assert.equal(decode_nodes(new ArrayBuffer(0)), undefined);
});

test("a node is drawn right only when it is confirmed or cannot be", () => {
  const nodes = new Nodes(6);
  nodes.take({ all: true, runs: [{ first: 0, many: 2, index: 4, flags: 1 }, { first: 2, many: 1, index: 3, flags: 0 }, { first: 3, many: 1, index: 3, flags: 2 }, { first: 4, many: 1, index: 3, flags: 6 }, { first: 5, many: 1, index: 4, flags: 8 }] });
  assert.deepEqual([0, 1, 2, 3, 4, 5].map((node) => nodes.drawn_state(node)), [0, 0, kDrawnWrong, kDrawnSilent, kDrawnSilent, 0]);
  assert.deepEqual(nodes.figures(), { right: 2, wrong: 1, silent: 1, quarantined: 1, unverified: 1 });
  assert.deepEqual([...nodes.switches()].sort(), [3, 4]);
  nodes.take({ all: false, runs: [{ first: 5, many: 2, index: 1, flags: 1 }] });
  assert.equal(nodes.figures().unverified, 1, "a run beyond the rig is of another rig");
  nodes.take({ all: true, runs: [] });
  assert.equal(nodes.figures().wrong, 6);
  const early = new Nodes();
  early.take({ all: true, runs: [{ first: 0, many: 3, index: 7, flags: 1 }] });
  early.fit(4);
  assert.deepEqual(early.figures(), { right: 3, wrong: 1, silent: 0, quarantined: 0, unverified: 0 }, "what is told before the rig is known stays");
});

test("layers keep what is used, and the oldest of the others makes room", () => {
  const layers = new Layers();
  for (let k = 0; k < kLayers; ++k) assert.equal(layers.take(100 + k, new Set()), k);
  layers.find(100);
  assert.equal(layers.take(7, new Set([101])), 2, "100 was asked for, 101 is shown: 102 goes");
  assert.equal(layers.find(102), undefined);
  assert.equal(layers.find(101), 1);
  assert.equal(layers.take(8, new Set([...Array(200).keys()])), undefined, "all are shown");
});

test("the switch of an instant is the last one before it", () => {
  assert.deepEqual([-1, 0, 0.99, 1, 5].map((time) => switch_at([0, 1, 2.5], time)), [-1, 0, 0, 1, 2]);
});

test("centres are those of the grids of docs/console.md", () => {
  const at = (grid, cell) => [...centres_of({ grid, columns: 3, rows: 2, pitch_m: 2 }).subarray(2 * cell, 2 * cell + 2)].map((value) => Math.round(1000 * value) / 1000);
  assert.deepEqual(at("square", 0), [-2, 1]);
  assert.deepEqual(at("square", 5), [2, 3]);
  assert.deepEqual(at("hexagonal", 3), [-1, 2.887]);
  assert.deepEqual(at("triangular", 0), [-1.732, 1]);
  assert.deepEqual(at("triangular", 1), [0, 2]);
});

test("one press is one GO: a held key repeats in vain until it is up", () => {
  const presses = new Presses();
  assert.ok(presses.press("Space", false));
  assert.ok(!presses.press("Space", true));
  assert.ok(!presses.press("Space", false));
  assert.ok(presses.press("KeyB", false));
  presses.release("Space");
  assert.ok(presses.press("Space", false));
});

const cues = [{ number: "1", name: "Line", to_s: 5, gap_after_s: null }, { number: "2", name: "Ring", to_s: 12, gap_after_s: 0 }, { number: "3", name: "Arrow", to_s: 20, gap_after_s: null }];
const state = (more) => ({ phase: "stands", position_s: 0, cue: null, standby: "1", goes_in_s: null, ends_in_s: null, holds_at_end: false, loop: null, reset: { state: "none" }, ...more });
const said = (more) => {
  const { phase, title, cue, standby, left_s, left_to, notice } = card_of(state(more), cues);
  return [phase, title, cue, standby, left_s, left_to, notice].filter((part) => part !== "" && part !== undefined).join(" | ");
};

test("the card tells what runs, what GO would do, and how long it lasts", () => {
  assert.equal(said({}), "stands | Stands | 1");
  assert.equal(said({ phase: "counts-in", cue: "1", standby: "2", goes_in_s: 1.5 }), "counts-in | Counts in | cue 1 Line | 2 | 1.5 | s: cue 1 begins");
  assert.equal(said({ phase: "runs", cue: "1", standby: "2", ends_in_s: 7 }), "runs | Runs | cue 1 Line | 2 | 7 | s until it");
  assert.equal(said({ phase: "runs", cue: "2", standby: "3", ends_in_s: 7 }), "runs | Runs | cue 2 Ring | 3 | 7 | s, then by itself");
  assert.equal(said({ phase: "runs", cue: "3", standby: null, ends_in_s: 7, holds_at_end: true }), "runs | Runs | cue 3 Arrow | the end | 7 | s until the end | HOLD at the end of the set");
  assert.equal(said({ cue: "2", standby: "3" }), "holds | HOLD | in cue 2 Ring | 3 | GO goes on with cue 2");
  assert.equal(said({ cue: "2", standby: "3", against: ["spotter left"] }), "holds | HOLD | in cue 2 Ring | 3 | HELD BY spotter left");
  assert.equal(said({ phase: "finished", standby: null }), "finished | The show is over");
  assert.equal(said({ phase: "a new one" }), "a new one | Stands | 1");
});

test("before it is armed GO says what is missing, and nobody is held", () => {
  assert.equal(said({ against: ["roll-call: nodes are asked"] }), "stands | Stands | 1 | NO GO YET: roll-call: nodes are asked");
});

test("the card tells who is not guided, and the notes of the standby cue", () => {
  assert.equal(said({ phase: "runs", cue: "1", standby: "2", ends_in_s: 7, muted: "day, dusk" }), "runs | Runs | cue 1 Line | 2 | 7 | s until it | NOT GUIDED: day, dusk");
  assert.equal(card_of(state({ standby_notes: "Smile." }), cues).notes, "Smile.");
});

test("what a HOLD would do is told while the show runs, what going on would after it", () => {
  const told = (more) => {
    const { freeze, unsafe } = card_of(state(more), cues);
    return [unsafe, freeze];
  };
  const runs = { phase: "runs", cue: "1", standby: "2", ends_in_s: 7 };
  assert.deepEqual(told({ ...runs, freeze: null }), [false, ""], "it is still being judged");
  assert.deepEqual(told({ ...runs, freeze: { pairs: 0, until_count: null, resume_pairs: 0 } }), [false, "HOLD is safe here"]);
  assert.deepEqual(told({ ...runs, freeze: { pairs: 1, until_count: 7.6, resume_pairs: 0 } }), [true, "HOLD now: 1 pair may touch until count 8. E, at the end, is better"]);
  assert.deepEqual(told({ ...runs, freeze: { pairs: 1234, until_count: null, resume_pairs: 0 } }), [true, "HOLD now: 1,234 pairs may touch. E, at the end, is better"]);
  assert.deepEqual(told({ cue: "1", freeze: { pairs: 9, until_count: null, resume_pairs: 3 } }), [true, "going on: 3 pairs may touch where people have walked on"]);
  assert.deepEqual(told({ cue: "1", freeze: { pairs: 9, until_count: null, resume_pairs: 0 } }), [false, ""]);
  assert.deepEqual(told({ freeze: { pairs: 9, until_count: null, resume_pairs: 0 } }), [false, ""], "nobody walks");
});

test("a change of the files can be taken when it is ready, and forgotten at any time", () => {
  const told = (state, text = "") => {
    const one = edit_text({ state, text, transitions: 2, people: 1400, untold: 0, absent: [] });
    return one && [one.head, one.text, one.takes, one.drops];
  };
  assert.equal(told("none"), undefined);
  assert.deepEqual(told("planning"), ["A change of the show is being planned …", "", false, true]);
  assert.deepEqual(told("wrong", "show.yaml:3:1: error: x"), ["THE CHANGED FILE IS WRONG. Nothing is changed by it.", "show.yaml:3:1: error: x", false, true]);
  assert.deepEqual(told("waits", "files"), ["Changed: 2 transitions, 1,400 people", "files", true, true]);
  assert.deepEqual(told("taking").slice(2), [false, true]);
});

test("a range and a group are picked as a whole, anybody else by name", () => {
  const show = { groups: [{ name: "dawn" }, { name: "Day" }], performers: [0, 0, 1, null].map((group, i) => ({ id: String(i + 1), name: String(i + 1), group })) };
  assert.deepEqual(many(show, "2-3"), [1, 2]);
  assert.deepEqual(many(show, "2 – 99"), [1, 2, 3]);
  assert.deepEqual(many(show, " day"), [2]);
  assert.deepEqual(["", "3", "3-2", "da", "5-9"].map((typed) => many(show, typed)), [[], [], [], [], []]);
  assert.deepEqual(["dawn", "da", ""].map((group) => is_muted("no one, dawn", group)), [true, false, false]);
  assert.equal(is_muted(undefined, "dawn"), false);
});

test("a reset move is asked for in words, and so is its impossibility", () => {
  assert.match(said({ reset: { state: "ready", from_s: 0, to_s: 12.5 } }), /GO lights the reset move to 0:12.5/);
  assert.match(said({ position_s: 3, reset: { state: "ready", from_s: 4, to_s: 12.5 } }), /GO: people walk on/);
  assert.match(said({ reset: { state: "being-planned", from_s: 0, to_s: 1 } }), /being planned/);
  assert.equal(said({ phase: "resets", cue: "3", standby: null, reset: { state: "ready", from_s: 15, to_s: 5 } }), "resets | Reset move | 2 | people walk to where they stand at 0:05.0");
  assert.match(said({ reset: { state: "impossible", from_s: 0, to_s: 1 } }), /NO RESET MOVE/);
});

test("facts that this page has no place for are told in words", () => {
  assert.equal(fact_text({ source: "ltc", locked: true, lost_s: null }), "source ltc, locked true, lost s –");
  assert.equal(fact_text(["a", { b: 1 }]), "a, b 1");
  assert.deepEqual([[], null, "", 0, false].map(is_empty), [true, true, true, false, false]);
});
