// SPDX-License-Identifier: Apache-2.0
// A performer's page: who she is, where she stands and goes, and how long it takes until then.

import { cell_name } from "../../../console/web/src/cell_name";
import { by_id, make, set_text, show_if } from "../../../console/web/src/dom";
import { counts_left, count_at, measure_beat } from "./counts";
import { keep, kept } from "./kept";
import { Line } from "./line";
import { now_of, type Place, with_way } from "./part";
import { StageMap } from "./stage_map";
import { type CastShow, cell_from, type State, type Where } from "./told";
import { type Language, say, set_language, spoken, translate, type Word } from "./words";

const kMostShown = 40;
const kSoon = 4; // counts

let show: CastShow | undefined;
let state: State | undefined;
let who = -1;
let own: Place[] = [];
let guided: Place[] | undefined; // her own places behind a way in
let reset: Place[] = [];
let reset_n = 0; // the reset move whose places these are
let fetched_epoch = 0;
let fetching = false;

const line = new Line({
  said: (message) => hear(message),
  changed: () => draw(),
  refused: () => {
    keep("token", "");
    line.token = "";
    line.offset_ms = undefined;
    draw();
  },
});
const map = new StageMap(by_id<HTMLCanvasElement>("map"), (cell) => choose(cell));

function hear(message: Record<string, unknown>): void {
  if (message.state) take_state(message.state as State);
  if (message.part) {
    const part = message.part as { who: number; places: Place[] };
    if (part.who === who) own = part.places;
  }
  if (message.way) {
    const way = message.way as { who: number; places: Place[] };
    if (way.who === who) reset = way.places;
  }
  if (message.where) answer(message.where as Where);
  if (message.busy) tell([["wait", say("busy")]]);
  if (message.stale) tell([["wait", say("stale")]]);
  draw();
}

function take_state(told: State): void {
  const jumped = state !== undefined && told.position_s < position_s() - 1;
  state = told;
  if (jumped) guided = undefined;
  if (told.epoch !== fetched_epoch) setTimeout(fetch_show, fetched_epoch === 0 ? 0 : 1500 * Math.random());
  const n = told.way ? told.way.n : 0;
  if (n !== reset_n) {
    reset_n = n;
    reset = [];
    if (n > 0) setTimeout(() => ask("way"), 1000 * Math.random());
  }
}

/** A house full of phones does not ask at one moment. */
function fetch_show(): void {
  if (!state || fetching || state.epoch === fetched_epoch) return;
  fetching = true;
  const epoch = state.epoch;
  fetch("api/show", { headers: { Authorization: `Bearer ${line.token}` } })
    .then((got) => (got.ok ? got.json() : Promise.reject(new Error(String(got.status)))))
    .then((json: CastShow) => {
      show = json;
      fetched_epoch = epoch;
      map.take(json.stage);
      who = json.performers.findIndex((one) => one.id === kept("who"));
      own = [];
      guided = undefined;
      ask("part");
      find();
      fetching = false;
      draw();
    })
    .catch(() => {
      fetching = false;
      setTimeout(fetch_show, 2000 + 2000 * Math.random());
    });
}

function ask(about: "part" | "way"): void {
  if (who >= 0) line.say({ [about]: { who, language: spoken() } });
}

/** Where the show is now, s. */
function position_s(): number {
  if (!state || state.at_ms === undefined) return 0;
  const at = state.position_s + (state.rate * (line.now_ms() - state.at_ms)) / 1000;
  return state.stops_s === null ? at : Math.min(at, Math.max(state.stops_s, state.position_s));
}

const shown = (cell: number): string => (show ? cell_name(cell, show.stage.columns) : "");
const count_words = (time_s: number): { count: number; measure: string } => {
  const count = show ? Math.ceil(count_at(show, time_s) - 1e-3) : 0;
  return { count, measure: show ? measure_beat(show, count) : "" };
};

// --- who ---

const folded = (text: string): string => text.normalize("NFKD").replace(/[\u0300-\u036f]/g, "").toLowerCase();

function find(): void {
  if (!show) return;
  const wanted = folded(by_id<HTMLInputElement>("search").value.trim());
  const found: number[] = [];
  let more = 0;
  show.performers.forEach((one, p) => {
    const exact = one.id === wanted;
    if (wanted && !exact && folded(one.name || one.id).indexOf(wanted) < 0 && one.id.indexOf(wanted) < 0) return;
    if (exact) found.unshift(p);
    else if (found.length < kMostShown) found.push(p);
    else ++more;
  });
  by_id("people").replaceChildren(
    ...found.map((p) => {
      const one = (show as CastShow).performers[p];
      const name = one.name || one.id;
      const button = make("button", name === one.id ? name : `${name} (${one.id})`);
      button.type = "button";
      button.addEventListener("click", () => be(p));
      const item = make("li");
      item.append(button);
      return item;
    }),
  );
  set_text(by_id("people_more"), more > 0 ? say("more", { n: more }) : found.length === 0 ? say("nobody") : "");
}

function be(performer: number): void {
  who = performer;
  keep("who", show && performer >= 0 ? show.performers[performer].id : "");
  own = reset = [];
  guided = undefined;
  ask("part");
  if (reset_n > 0) ask("way");
  stay_awake();
  draw();
}

function stay_awake(): void {
  const wake = (navigator as { wakeLock?: { request(kind: string): Promise<unknown> } }).wakeLock;
  if (wake && document.visibilityState === "visible") wake.request("screen").catch(() => undefined);
}

// --- now ---

function banner(head: string, note: string, wrong = false): void {
  const part = by_id("banner");
  show_if(part, head !== "");
  part.classList.toggle("wrong", wrong);
  set_text(by_id("banner_head"), head);
  set_text(by_id("banner_note"), note);
}

/** What stands over everything else. @return whether what is below it can be believed */
function draw_banner(): boolean {
  const told = state;
  if (!line.connected) {
    banner(say("no_link"), say("not_heard_note"), true);
    return false;
  }
  if (!told || !told.heard || told.phase === undefined) {
    banner(say("not_heard"), say("not_heard_note"), true);
    return false;
  }
  if (!told.same_plan) {
    banner(say("other_plan"), say("other_plan_note"), true);
    return false;
  }
  if (show && who >= 0 && show.performers[who].absent) banner(say("absent"), "", true);
  else if (told.phase === "resets" || told.phase === "reset-held") {
    banner(say(told.phase === "resets" ? "reset" : "hold"), told.phase === "resets" ? "" : say("hold_note"));
  } else if (told.way && reset.length > 0) banner(say("reset_ready", { cell: shown(reset[reset.length - 1].cell) }), say("reset_wait"));
  else if (told.phase === "stands" && told.cue) banner(say("hold"), say("hold_note"));
  else if (told.phase === "stands") banner(say("wait_go", { cue: told.standby }), "");
  else if (told.phase === "finished") banner(say("over"), "");
  else if (told.holds_at_end) banner(say("hold_end"), "");
  else banner("", "");
  return true;
}

function draw_clock(left: number | undefined, of: Word | undefined): void {
  const part = by_id("left");
  set_text(part, left === undefined ? "–" : String(left));
  part.classList.toggle("soon", left !== undefined && left <= kSoon);
  set_text(by_id("left_of"), of ? say(of) : "");
}

function draw_arrow(from: number, to: number | undefined): void {
  const arrow = document.getElementById("arrow") as unknown as SVGElement;
  if (to === undefined || to === from) {
    arrow.style.visibility = "hidden";
    return;
  }
  const a = map.centre(from);
  const b = map.centre(to);
  // Audience above: +x is to the left, +y is down.
  arrow.style.visibility = "visible";
  arrow.style.transform = `rotate(${Math.round((Math.atan2(-(b.x - a.x), -(b.y - a.y)) * 180) / Math.PI)}deg)`;
}

/** As large as the phone allows: beside each other where it lies on its side. */
function fit(part: HTMLElement): void {
  const sideways = innerWidth > innerHeight;
  const wide = ((sideways ? 0.6 : 1.2) * innerWidth) / Math.max(2, (part.textContent || "").length);
  const size = `${Math.round(Math.min(wide, (sideways ? 0.42 : 0.3) * innerHeight))}px`;
  if (part.style.fontSize !== size) part.style.fontSize = size;
}

function draw_now(believed: boolean): void {
  const told = state as State;
  const resets = told.phase === "resets" || told.phase === "reset-held";
  const in_reset = resets && reset.length > 0;
  const at_s = in_reset ? ((told.way && told.way.at_s) || 0) + (((told.way && told.way.rate) || 0) * (line.now_ms() - told.at_ms)) / 1000 : position_s();
  const places = in_reset ? reset : guided || own;
  const now = now_of(places, at_s);
  show_if(by_id("here"), now !== undefined);
  const next = now && (now.walks ? now.then : now.next);
  show_if(by_id("then"), next !== undefined);
  if (!now || !show) return draw_clock(undefined, undefined);
  by_id("here").classList.toggle("walks", now.walks);
  const to = now.walks && now.next ? now.next : now.here;
  set_text(by_id("doing"), say(now.walks ? "walk" : "stand"));
  set_text(by_id("cell"), shown(to.cell));
  fit(by_id("cell"));
  set_text(by_id("place"), now.walks ? now.here.way : to.place);
  set_text(by_id("beside"), now.walks ? "" : now.here.beside);
  set_text(by_id("next_cell"), next ? shown(next.cell) : "");
  set_text(by_id("way"), to.way);
  draw_arrow(now.here.cell, now.next && now.next.cell);
  if (!believed) return draw_clock(undefined, undefined);
  if (told.goes_at_ms !== null && (told.phase === "counts-in" || told.phase === "resets")) {
    const bpm = show.tempo.filter((one) => one.time_s <= position_s()).reduce((_, one) => one.bpm, show.tempo[0].bpm);
    const left_s = Math.max(0, (told.goes_at_ms - line.now_ms()) / 1000);
    return draw_clock(Math.ceil((left_s * bpm * told.tempo_percent) / 6000), "until_go");
  }
  const music = in_reset ? { tempo: [{ count: 1, time_s: 0, bpm: bpm_of(reset) }], meter: show.meter } : show;
  if (now.change_s === undefined) return draw_clock(undefined, "to_the_end");
  draw_clock(counts_left(music, at_s, now.change_s), now.walks ? "until_there" : "until_walk");
}

/** The tempo of a reset move, by two of its places. */
function bpm_of(places: Place[]): number {
  const [a, b] = [places[0], places[places.length - 1]];
  const s = b.from_s - a.from_s;
  return s > 0 ? (60 * (Number(b.count) - Number(a.count))) / s : 120;
}

function draw(): void {
  const joined = line.token !== "";
  show_if(by_id("join"), !joined);
  const known = joined && show !== undefined && state !== undefined;
  show_if(by_id("pick"), known && who < 0);
  show_if(by_id("now"), joined && (who >= 0 || !known));
  show_if(by_id("foot"), known && who >= 0);
  show_if(by_id("change"), who >= 0);
  if (!joined) return;
  const believed = draw_banner();
  if (!known || who < 0 || !show || !state) return;
  const one = show.performers[who];
  set_text(by_id("title"), one.name || one.id);
  draw_now(believed);
  const count = Math.floor(count_at(show, position_s()) + 1e-3);
  set_text(by_id("bar"), believed ? `${measure_beat(show, count)}  ${say("count")} ${count}` : "–");
  const cue = show.cues.filter((it) => it.number === (state as State).cue)[0];
  set_text(by_id("cue"), cue ? `${cue.number} ${cue.name}` : "");
}

// --- where ---

let here = -1;
let shown_way: number[] = [];

function choose(cell: number): void {
  here = cell;
  by_id<HTMLInputElement>("lost_cell").value = shown(cell);
  tell([]);
  draw_map([]);
}

function draw_map(way: number[] = shown_way): void {
  shown_way = way;
  const now = now_of(own, position_s());
  map.draw(here, now ? (now.walks && now.next ? now.next.cell : now.here.cell) : -1, way);
}

function tell(lines: [string, string][]): void {
  by_id("answer").replaceChildren(...lines.map(([kind, text]) => (kind === "" ? make("p", text) : make("b", text, kind))));
  draw_map(); // there is more or less room for it now
}

function answer(where: Where): void {
  const places = where.places || [];
  const ask_at = count_words(where.ask_s || 0);
  const plain: Record<string, Word> = { "not-heard": "not_heard", "other-plan": "other_plan", absent: "absent", "no-cell": "no_cell", held: "held", reset: "in_reset", nowhere: "nowhere" };
  if (plain[where.kind]) return tell([["wait", say(plain[where.kind])]]);
  if (where.kind === "here") return tell([["go", say("here")]]);
  if (where.kind === "wait") return tell([["wait", say("wait", { ...ask_at })]]);
  shown_way = places.map((one) => one.cell);
  const legs: [string, string][] = places.slice(1).map((one, k) => ["", say("leg", { cell: shown(one.cell), way: places[k].way })]);
  const last = places[places.length - 1];
  if (where.kind === "aside") return tell([["wait", say("aside", { cell: shown(last.cell), ...ask_at })], ...legs]);
  const head = where.at_once ? say("join_now") : say("join", count_words(places[0].until_s));
  tell([["go", head], ...legs, ["go", say("arrive", { cell: shown(last.cell) })]]);
  if (!where.at_once) guided = with_way(own, places);
}

function fill_landmarks(): void {
  if (!show) return;
  const { columns, rows } = show.stage;
  const first = map.centre(0);
  const last = map.centre(columns * rows - 1);
  const middle = { x: (first.x + last.x) / 2, y: (first.y + last.y) / 2 };
  const spots: [Word, number, number][] = [
    ["stage_left", last.x, middle.y], ["centre", middle.x, middle.y], ["stage_right", first.x, middle.y],
    ["downstage", middle.x, first.y], ["upstage", middle.x, last.y],
  ];
  by_id("marks").replaceChildren(
    ...spots.map(([word, x, y]) => {
      const button = make("button", say(word));
      button.type = "button";
      button.addEventListener("click", () => choose(map.nearest(x, y)));
      return button;
    }),
  );
}

// --- the page ---

function join(code: string): void {
  fetch("api/pair", { method: "POST", headers: { "Content-Type": "application/json", "X-Footlight": "1" }, body: JSON.stringify({ code }) })
    .then((got) => got.json() as Promise<{ token?: string; error?: string }>)
    .then((got) => {
      set_text(by_id("join_why"), got.token ? "" : got.error || "?");
      if (!got.token) return;
      line.token = got.token;
      keep("token", got.token);
      line.connect();
      draw();
    })
    .catch(() => set_text(by_id("join_why"), say("no_link")));
}

function speak(to: Language): void {
  set_language(to);
  keep("language", to);
  translate(document);
  fill_landmarks();
  find();
  ask("part");
  if (reset_n > 0) ask("way");
  draw();
}

function begin(): void {
  const dark_wanted = !window.matchMedia("(prefers-color-scheme: light)").matches;
  const theme = kept("theme");
  if (theme) document.documentElement.dataset.theme = theme;
  by_id("theme").addEventListener("click", () => {
    const is_dark = document.documentElement.dataset.theme ? document.documentElement.dataset.theme === "dark" : dark_wanted;
    document.documentElement.dataset.theme = is_dark ? "light" : "dark";
    keep("theme", is_dark ? "light" : "dark");
  });
  by_id("language").addEventListener("click", () => speak(spoken() === "en" ? "zh" : "en"));
  by_id("change").addEventListener("click", () => be(-1));
  by_id("search").addEventListener("input", find);
  by_id("join").addEventListener("submit", (event) => {
    event.preventDefault();
    join(by_id<HTMLInputElement>("code").value);
  });
  by_id("where").addEventListener("click", () => {
    show_if(by_id("lost_panel"), true);
    fill_landmarks();
    draw_map([]);
  });
  by_id("lost_close").addEventListener("click", () => show_if(by_id("lost_panel"), false));
  by_id("lost_form").addEventListener("submit", (event) => {
    event.preventDefault();
    const cell = show ? cell_from(by_id<HTMLInputElement>("lost_cell").value, show.stage) : -1;
    if (cell < 0) return tell([["wait", say("unknown_cell")]]);
    here = cell;
    tell([["", say("asking")]]);
    draw_map([]);
    if (!line.say({ where: { who, cell, language: spoken() } })) tell([["wait", say("no_link")]]);
  });
  document.addEventListener("visibilitychange", stay_awake);
  // The code of a link never goes over the network but in the body of the one request that it is for.
  const code = location.hash.slice(1);
  if (code) history.replaceState(null, "", location.pathname);
  line.token = kept("token");
  const language = kept("language") || (navigator.language.toLowerCase().startsWith("zh") ? "zh" : "en");
  speak(language === "zh" ? "zh" : "en");
  if (line.token) line.connect();
  else if (code) join(code);
  draw();
  setInterval(draw, 100);
}

begin();
