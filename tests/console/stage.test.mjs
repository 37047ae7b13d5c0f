// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import test from "node:test";
import { Camera } from "../../app/console/web/src/camera.ts";
import { cell_name, column_letters } from "../../app/console/web/src/cell_name.ts";
import { cell_from, find, range_from } from "../../app/console/web/src/find.ts";
import { mark_before, nearest, next_place, position_at } from "../../app/console/web/src/tracks.ts";

// Two people on a row of four cells, 1 m apart: one walks 0 -> 2 from 1 s to 3 s, the other waits on 3.
const centres = new Float32Array([0, 0, 1, 0, 2, 0, 3, 0]);
const tracks = { starts: new Uint32Array([0, 4, 6]), marks: new Int32Array([0, 0, 1000, 0, 3000, 2, 9000, 2, 0, 3, 9000, 3]) };

test("people walk straight and at constant speed from mark to mark", () => {
  const x = (time_ms) => position_at(tracks, centres, 0, time_ms).x;
  assert.equal(x(-500), 0);
  assert.equal(x(1000), 0);
  assert.equal(x(1500), 0.5);
  assert.equal(x(2500), 1.5);
  assert.equal(x(3000), 2);
  assert.equal(x(99000), 2);
  assert.equal(position_at(tracks, centres, 1, 2000).x, 3);
});

test("the position agrees with a search through all marks, at random instants", () => {
  let seed = 7;
  const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
  for (let round = 0; round < 200; ++round) {
    const many = 1 + Math.floor(random() * 9);
    const marks = [];
    for (let i = 0, time = -1000; i < many; ++i) marks.push((time += 1 + Math.floor(random() * 3000)), Math.floor(random() * 4));
    const one = { starts: new Uint32Array([0, many]), marks: new Int32Array(marks) };
    const at = Math.floor(random() * 20000) - 2000;
    let slow = 0;
    for (let i = 0; i < many; ++i) if (marks[2 * i] <= at) slow = i;
    assert.equal(mark_before(one, 0, at), slow);
    const p = position_at(one, centres, 0, at).x;
    const ends = [centres[2 * marks[2 * slow + 1]], centres[2 * (marks[2 * Math.min(many - 1, slow + 1) + 1])]];
    assert.ok(p >= Math.min(...ends) && p <= Math.max(...ends));
  }
});

test("the next place is where somebody stands next, not where she stands now", () => {
  assert.deepEqual(next_place(tracks, 0, 0), { time_ms: 3000, cell: 2 });
  assert.deepEqual(next_place(tracks, 0, 2000), { time_ms: 3000, cell: 2 });
  assert.equal(next_place(tracks, 0, 3000), undefined);
  assert.equal(next_place(tracks, 1, 0), undefined);
});

test("who is picked is the nearest, and nobody when all are far", () => {
  assert.equal(nearest(tracks, centres, 2000, { x: 1.2, y: 0 }, 0.5), 0);
  assert.equal(nearest(tracks, centres, 2000, { x: 2.9, y: 0.1 }, 0.5), 1);
  assert.equal(nearest(tracks, centres, 2000, { x: 2, y: 5 }, 0.5), -1);
});

test("cells are called as the program calls them", () => {
  assert.deepEqual([0, 25, 26, 51, 52, 701, 702].map(column_letters), ["A", "Z", "AA", "AZ", "BA", "ZZ", "AAA"]);
  assert.equal(cell_name(0, 144), "A1");
  assert.equal(cell_name(144 * 89 + 143, 144), "EN90");
  for (const cell of [0, 7, 143, 144, 12959]) assert.equal(cell_from(cell_name(cell, 144).toLowerCase(), 144, 90), cell);
  assert.equal(cell_from("EO1", 144, 90), undefined);
  assert.equal(cell_from("A91", 144, 90), undefined);
  assert.equal(cell_from("A0", 144, 90), undefined);
});

test("people are found by id, number, range and group, cells and nodes by name", () => {
  const show = {
    stage: { columns: 12, rows: 8 },
    groups: [{ name: "left" }, { name: "right" }],
    performers: [...Array(12)].map((_, i) => ({ id: `P${i + 1}`, name: i === 4 ? "Wei" : `P${i + 1}`, group: i < 6 ? 0 : 1 })),
    rig: [{ name: "n1", bus: 0, address: 1 }],
    buses: [{ name: "east" }],
  };
  const said = (text) => find(show, text).map((found) => `${found.kind} ${found.index}`);
  assert.equal(said("P1")[0], "performer 0");
  assert.deepEqual(said(" 3-5 "), ["performer 2", "performer 3", "performer 4"]);
  assert.deepEqual(said("right").length, 6);
  assert.deepEqual(said("wei"), ["performer 4"]);
  assert.deepEqual(said("D2"), ["cell 15"]);
  assert.deepEqual(said("n1"), ["node 0"]);
  assert.deepEqual(said("<b>"), []);
  assert.deepEqual(range_from("100-200"), { from: 100, to: 200 });
  assert.equal(range_from("1-"), undefined);
});

function camera(front) {
  const one = new Camera();
  one.size = { width: 800, height: 500 };
  one.fit({ low: { x: -40, y: -5 }, high: { x: 40, y: 50 } });
  one.front = front;
  return one;
}

test("a pixel is the place that is drawn there, from above and from the audience", () => {
  for (const front of [false, true]) {
    for (const at of [{ x: 0, y: 0 }, { x: -30, y: 40 }, { x: 12.5, y: 7 }]) {
      const p = camera(front).project(at);
      const back = camera(front).unproject(p.x, p.y);
      assert.ok(Math.hypot(back.x - at.x, back.y - at.y) < 1e-3, `${front} ${JSON.stringify(back)}`);
    }
  }
});

test("stage left is on the right of the screen, and upstage is up; the audience sees downstage larger", () => {
  for (const front of [false, true]) {
    const one = camera(front);
    assert.ok(one.project({ x: 10, y: 10 }).x > one.project({ x: -10, y: 10 }).x);
    assert.ok(one.project({ x: 0, y: 40 }).y < one.project({ x: 0, y: 0 }).y);
  }
  const one = camera(true);
  assert.ok(one.project({ x: 0, y: 0 }).scale > 1.2 * one.project({ x: 0, y: 45 }).scale);
  assert.ok(one.project({ x: 0, y: 10 }, 1.75).y < one.project({ x: 0, y: 10 }).y, "heads are above feet");
});

test("what is under the pointer stays there while zooming; the whole stage fits without", () => {
  const one = camera(false);
  for (const corner of [{ x: -40, y: -5 }, { x: 40, y: 50 }]) {
    const p = one.project(corner);
    assert.ok(p.x >= -1e-3 && p.x <= 800.001 && p.y >= -1e-3 && p.y <= 500.001);
  }
  const before = one.unproject(500, 200);
  one.zoom(3, 500, 200);
  const after = one.unproject(500, 200);
  assert.ok(Math.hypot(after.x - before.x, after.y - before.y) < 1e-3);
  one.pan(500, 200, 450, 220);
  const moved = one.unproject(450, 220);
  assert.ok(Math.hypot(moved.x - before.x, moved.y - before.y) < 1e-3);
});
