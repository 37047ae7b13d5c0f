// SPDX-License-Identifier: Apache-2.0
// The console: connects the program with the panels.

import { draw_edit, draw_question, draw_swap } from "./asked";
import { CueList } from "./cue_list";
import { DeskPanel } from "./desk_panel";
import { by_id, make, set_text, show_if } from "./dom";
import { FindPanel, many } from "./find";
import { listen_to_keys } from "./keys";
import { kTokenWanted, Link } from "./link";
import { Looks } from "./looks";
import { Model, type Person } from "./model";
import { PeoplePanel } from "./people_panel";
import { draw_person } from "./person_card";
import { Orders } from "./orders";
import { type Alarm, type BusHealth, decode_nodes, decode_plan, type RunEvent, type State } from "./protocol";
import { Selection } from "./selection";
import { Program, send_show, Unauthorised } from "./show_data";
import { SidePanels } from "./side_panels";
import { StageView } from "./stage_view";
import { Timeline } from "./timeline";
import { type Language, say, set_language, translate, type Word } from "./words";

const kThemes = ["dark", "light", "contrast"];
const kKeys: [string, Word][] = [["Space", "key_go"], ["Esc", "key_hold"], ["E", "key_end"], ["B  T", "key_back"], ["S", "key_step"], ["O  M", "key_mute"], ["↑ ↓  Enter", "key_choose"],
  ["J  L  N  :", "key_ask"], ["+ −  .", "key_tempo"], ["P  C", "key_reset"], ["A", "key_ok"], ["V  1 2 3 4  0", "key_view"], ["/", "key_find"], ["", "key_pan"]];

/** What is kept over a reload; a browser that keeps nothing is as good. */
function kept(name: string, value?: string): string | undefined {
  try {
    if (value !== undefined) sessionStorage.setItem(name, value);
    return sessionStorage.getItem(name) ?? undefined;
  } catch {
    return undefined;
  }
}

class Console {
  private readonly model_ = new Model();
  private readonly program_ = new Program();
  private readonly link_ = new Link({
    opened: () => void this.fetch_show(),
    said: (message) => this.take(message),
    frame: (bytes) => this.take_frame(bytes),
    closed: (code) => this.closed(code),
  }, () => kept("name") ?? "stage manager");
  private readonly desk_ = new DeskPanel(this.model_);
  private readonly orders_ = new Orders(this.model_, this.link_, this.desk_);
  private readonly selection_ = new Selection(this.model_, () => this.stage_);
  private readonly cues_ = new CueList(this.model_, (number) => this.orders_.say(`jump cue ${number}`));
  private readonly side_ = new SidePanels(this.model_, (n) => this.link_.say({ acknowledge: n }), (order) => this.orders_.say(order));
  private readonly timeline_ = new Timeline(this.model_, () => undefined);
  private readonly find_ = new FindPanel(this.model_, (found) => this.selection_.find(found), (all) => this.selection_.take_all(all));
  private readonly people_ = new PeoplePanel(this.model_, (order) => this.orders_.say(order), (prefix) => this.orders_.ask(prefix), (name) => this.pick(name));
  private stage_?: StageView;
  private readonly looks_ = new Looks(this.model_, () => this.stage_?.scene, (path) => this.program_.bytes(path));
  private resets_: string | undefined; // the reset move that is here
  private fetching_ = false;
  private was_connected_ = false;
  private slow_at_ms_ = -Infinity;

  start(): void {
    set_language((kept("language") as Language | undefined) ?? (navigator.language.startsWith("zh") ? "zh" : "en"));
    document.documentElement.dataset.theme = kept("theme") ?? "dark";
    this.speak();
    try {
      this.stage_ = new StageView(this.model_, (performer) => this.selection_.take(performer));
    } catch (error) {
      set_text(by_id("legend"), say("no_webgl", { why: String(error) }));
    }
    by_id("floor").addEventListener("webglcontextlost", () => location.reload());
    this.listen();
    this.program_.token = this.link_.token = kept("token");
    this.link_.connect();
    const frame = (now_ms: number) => {
      this.draw(now_ms);
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  // What comes.

  private take(message: Record<string, unknown>): void {
    const { model_: model } = this;
    if (message.welcome) {
      const welcome = message.welcome as { you: number; role: string };
      model.me = welcome.you;
      model.role = welcome.role;
    }
    if (message.state) this.take_state(message.state as State);
    if ("seat" in message) this.take_seat(message.seat as { holder: number; name: string } | null);
    if (message.people) model.people = message.people as Person[];
    if (Array.isArray(message.untold)) model.untold = message.untold.map(String);
    if (message.alarms) {
      model.alarms = message.alarms as Alarm[];
      this.side_.draw_alarms();
    }
    if (message.health) model.health = (message.health as { buses: BusHealth[] }).buses;
    if (message.log) for (const event of message.log as RunEvent[]) this.side_.log(event);
    if (typeof message.n === "number") this.take_event(message as unknown as RunEvent);
    if (typeof message.epoch === "number" && message.epoch !== model.show?.epoch) void this.fetch_show();
    if (message.code) {
      const { code, seconds } = message.code as { code: string; seconds: number };
      set_text(by_id("code"), say("code", { code, seconds }));
    }
    if (message.seat !== undefined || message.people || message.welcome) this.side_.draw_people();
  }

  private take_state(state: State): void {
    if (this.model_.state?.ready !== state.ready) this.looks_.nodes_changed();
    this.model_.take_state(state, performance.now());
    const wanted = state.reset.state === "ready" || state.phase === "resets" || state.phase === "reset-held";
    const which = wanted ? `${state.reset.from_s} ${state.reset.to_s}` : undefined;
    if (which !== this.resets_) {
      this.resets_ = which;
      if (which === undefined) this.take_way(undefined);
      else void this.program_.bytes("api/way.bin").then((bytes) => this.resets_ === which && this.take_way(bytes));
    }
    const into_s = state.reset.at_s;
    if (into_s !== undefined) this.model_.way_clock.tell({ position_s: into_s, rate: state.rate ?? 0, came_ms: performance.now() });
  }

  private take_way(bytes: ArrayBuffer | undefined): void {
    const { show } = this.model_;
    this.model_.way = bytes && show ? decode_plan(bytes, show.stage.columns * show.stage.rows).tracks : undefined;
    this.stage_?.scene.take_way(this.model_.way);
    this.stage_?.redraw();
  }

  private take_seat(seat: { holder: number; name: string } | null): void {
    const { model_: model } = this;
    model.holder = seat ? { id: seat.holder, name: seat.name } : null;
    if (model.leads()) kept("led", "yes");
    else if (seat !== null) kept("led", "no"); // somebody has taken it over
    else if (kept("led") === "yes" && model.role !== "view") this.link_.say({ seat: "take" }); // it was ours before the connection broke
  }

  private take_event(event: RunEvent): void {
    this.side_.log(event);
    if (event.answer?.refused) this.desk_.refuse(event.answer.order, event.answer.text);
  }

  private take_frame(bytes: ArrayBuffer): void {
    const frame = decode_nodes(bytes);
    if (!frame) return;
    this.model_.nodes.take(frame);
    this.looks_.nodes_changed();
    this.stage_?.redraw();
  }

  private async fetch_show(): Promise<void> {
    if (this.fetching_) return;
    this.fetching_ = true;
    try {
      const { show, tracks, centres } = await this.program_.show();
      this.model_.take_show(show, tracks, centres);
      this.looks_.clear();
      this.build();
    } catch (error) {
      if (error instanceof Unauthorised) this.join();
      else this.desk_.refuse("", say("show_failed", { why: String(error) }));
    } finally {
      this.fetching_ = false;
    }
  }

  private build(): void {
    const { show, tracks, centres, selected, marked } = this.model_;
    if (!show || !tracks) return;
    document.title = `${show.title} – Footlight`;
    set_text(by_id("title"), show.title);
    const stamp = [show.version, show.plan.slice(0, 8), say("markers_word", { n: show.markers.toLocaleString("en"), nodes: show.nodes })];
    set_text(by_id("stamp"), stamp.filter(Boolean).join(" · "));
    this.cues_.build();
    this.timeline_.build();
    if (this.stage_) send_show(this.stage_.scene, show, tracks, centres, selected >= 0 ? [selected] : marked);
    this.stage_?.take_show();
  }

  private closed(code: number): void {
    this.side_.draw_link(undefined, false);
    if (code === kTokenWanted) this.join();
  }

  // What is touched.

  private listen(): void {
    for (const button of document.querySelectorAll<HTMLElement>("[data-order]")) button.addEventListener("click", () => this.orders_.named(button.dataset.order ?? ""));
    for (const button of document.querySelectorAll<HTMLElement>("[data-ask]")) button.addEventListener("click", () => this.orders_.ask(button.dataset.ask ?? ""));
    by_id("say").addEventListener("submit", (event) => {
      event.preventDefault();
      const field = by_id<HTMLInputElement>("order");
      if (field.value.trim()) this.orders_.say(field.value.trim());
      field.value = "";
      field.blur();
    });
    by_id("take_seat").addEventListener("click", () => this.link_.say({ seat: this.model_.leads() ? "leave" : "take" }));
    by_id("language").addEventListener("click", () => {
      kept("language", document.documentElement.lang.startsWith("zh") ? "en" : "zh");
      set_language(kept("language") as Language);
      this.speak();
    });
    by_id("theme").addEventListener("click", () => {
      const root = document.documentElement;
      root.dataset.theme = kThemes[(kThemes.indexOf(root.dataset.theme ?? "dark") + 1) % kThemes.length];
      kept("theme", root.dataset.theme);
      this.stage_?.take_theme();
    });
    by_id("open_side").addEventListener("click", () => document.body.classList.toggle("side"));
    by_id("show_help").addEventListener("click", () => by_id<HTMLDialogElement>("help").showModal());
    by_id("help_close").addEventListener("click", () => by_id<HTMLDialogElement>("help").close());
    by_id("person_close").addEventListener("click", () => this.selection_.take(-1));
    for (const button of document.querySelectorAll<HTMLElement>("[data-person]")) button.addEventListener("click", () => this.of_person(button.dataset.person ?? ""));
    for (const answer of ["yes", "no", "skip"]) by_id(`probe_${answer}`).addEventListener("click", () => this.orders_.say(`probe ${answer}`));
    by_id("swap_off").addEventListener("click", () => this.orders_.say("swap off"));
    for (const role of ["view", "operate"]) by_id(`pair_${role}`).addEventListener("click", () => this.link_.say({ pair: role }));
    by_id("join_form").addEventListener("submit", (event) => {
      event.preventDefault();
      void this.joined(by_id<HTMLInputElement>("join_code").value.trim());
    });
    // A dialog's own Esc would close it and hold the show.
    for (const dialog of document.querySelectorAll("dialog")) dialog.addEventListener("cancel", (event) => event.preventDefault());
    listen_to_keys({
      go: () => this.orders_.say("go"),
      hold: () => this.orders_.say("hold"),
      hold_end: () => this.orders_.named("hold_end"),
      say: (order) => this.orders_.say(order),
      ask: (prefix) => this.orders_.ask(prefix),
      loop: () => this.orders_.named("loop"),
      mute: () => this.orders_.named("mute"),
      solo: () => this.orders_.named("solo"),
      tempo: (by) => this.orders_.tempo(by),
      move: (by) => this.cues_.move(by),
      jump: () => this.cues_.jump(),
      placed: () => this.orders_.say("placed"),
      ok: () => this.ok(),
      find: () => this.open_find(),
      help: () => by_id<HTMLDialogElement>("help").showModal(),
      close: () => this.close_one(),
      view: (what) => this.change_view(what),
      zoom: (factor) => this.stage_?.zoom(factor),
    });
  }

  private ok(): void {
    for (const alarm of this.model_.alarms) if (alarm.acknowledged_by === null) this.link_.say({ acknowledge: alarm.n });
    this.orders_.say("ok");
  }

  /** What is said of whom was picked; what ends with dots is finished by hand. */
  private of_person(order: string): void {
    const one = this.model_.show?.performers[this.model_.selected];
    if (!one) return;
    if (order === "note") this.orders_.ask(`note person ${one.id} `);
    else if (order === "cover") this.orders_.ask(`cover ${one.id}`);
    else this.orders_.say(`${order} ${one.id}`);
  }

  /** A group, or somebody by her id. */
  private pick(name: string): void {
    const { show } = this.model_;
    if (!show) return;
    const index = show.performers.findIndex((one) => one.id === name);
    if (index >= 0) this.selection_.find({ kind: "performer", index, text: name });
    else this.selection_.take_all(many(show, name));
  }

  private open_find(): void {
    document.body.classList.add("side");
    this.side_.open("find");
    this.find_.focus();
  }

  private change_view(what: "front" | "people" | "lamps" | "ghosts" | "ways" | "all"): void {
    if (what === "front") this.stage_?.turn();
    else if (what === "all") this.stage_?.whole();
    else this.stage_?.choose(what);
  }

  /** What is open, the innermost first. */
  private close_one(): boolean {
    const help = by_id<HTMLDialogElement>("help");
    const active = document.activeElement;
    if (help.open) return help.close(), true;
    if (active instanceof HTMLInputElement && active.type !== "range") return active.blur(), true;
    return false;
  }

  // Who may come in.

  private join(): void {
    const dialog = by_id<HTMLDialogElement>("join");
    if (!dialog.open) dialog.showModal();
  }

  private async joined(typed: string): Promise<void> {
    const paired = /^\d{8}$/.test(typed) ? await this.program_.pair(typed) : { token: typed };
    set_text(by_id("join_refused"), paired.error ?? "");
    if (!paired.token) return;
    this.program_.token = this.link_.token = paired.token;
    kept("token", paired.token);
    by_id<HTMLDialogElement>("join").close();
    this.link_.connect();
  }

  private speak(): void {
    translate(document);
    const keys = by_id("help_keys");
    keys.replaceChildren(...kKeys.flatMap(([key, word]) => [make("dt", key === "Space" ? say("key_space") : key), make("dd", say(word))]));
    this.side_.draw_people();
    this.side_.draw_alarms();
    this.stage_?.redraw();
  }

  // Every frame; what costs more than a glance only four times a second.

  private draw(now_ms: number): void {
    const planned = this.looks_.prepare();
    this.stage_?.draw(now_ms, planned, this.looks_.blink());
    this.desk_.draw(now_ms);
    this.timeline_.draw(now_ms);
    if (now_ms - this.slow_at_ms_ < 250) return;
    this.slow_at_ms_ = now_ms;
    this.cues_.draw();
    this.side_.draw_health();
    this.side_.draw_stages();
    this.people_.draw();
    draw_edit(this.model_);
    draw_swap(this.model_);
    draw_question(this.model_);
    draw_person(this.model_, this.looks_, now_ms);
    this.draw_lost();
  }

  private draw_lost(): void {
    const connected = this.link_.connected();
    this.was_connected_ ||= connected;
    this.side_.draw_link(this.link_.round_trip_ms, connected);
    const since_s = (performance.now() - this.link_.heard_ms()) / 1000;
    show_if(by_id("lost"), !connected && this.was_connected_);
    const time = new Date(Date.now() - since_s * 1000).toLocaleTimeString("en-GB");
    set_text(by_id("lost_since"), say("lost_since", { time, seconds: Math.round(since_s) }));
  }

  /** For whoever measures. */
  cost(): StageView["cost"] | undefined {
    return this.stage_?.cost;
  }

  measure(): void {
    this.stage_?.measure();
  }
}

const page = new Console();
Object.assign(globalThis, { footlight: { cost: () => page.cost(), measure: () => page.measure() } });
page.start();
