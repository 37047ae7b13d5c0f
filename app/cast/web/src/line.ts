// SPDX-License-Identifier: Apache-2.0
// The connection: says hello, keeps the clock of the program, and comes back by itself, not at the same moment as all.

export interface Listener {
  said(message: Record<string, unknown>): void;
  changed(): void; // connected or not
  refused(): void; // the token is not good
}

const kSilence_ms = 7000; // the program speaks every two seconds at least
const kFirstWait_ms = 500;
const kLongestWait_ms = 8000;
const kPing_ms = 20000;
const kFirstPings = 3;
const kTokenRefused = 4401;

export class Line {
  private socket_?: WebSocket;
  private heard_ms_ = 0;
  private wait_ms_ = kFirstWait_ms;
  private pings_ = 0;
  private pinged_ms_ = 0;
  private best_ms_ = Infinity; // round trip of the best ping
  /** Add it to performance.now() for the program's clock, ms. */
  offset_ms: number | undefined;
  connected = false;
  token = "";

  constructor(private readonly listener_: Listener) {
    setInterval(() => this.watch(), 500);
  }

  connect(): void {
    if (this.socket_ || !this.token) return;
    const socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/ws`);
    this.socket_ = socket;
    this.heard_ms_ = performance.now();
    this.pings_ = 0;
    this.best_ms_ = Infinity;
    socket.onopen = () => socket.send(JSON.stringify({ hello: { token: this.token } }));
    socket.onmessage = (event: MessageEvent<string>) => this.heard(String(event.data));
    socket.onclose = (event) => {
      if (this.socket_ === socket) this.lost(event.code);
    };
  }

  say(message: Record<string, unknown>): boolean {
    if (!this.connected || !this.socket_) return false;
    this.socket_.send(JSON.stringify(message));
    return true;
  }

  /** The program's clock, ms. */
  now_ms(): number {
    return performance.now() + (this.offset_ms || 0);
  }

  private heard(data: string): void {
    const now = performance.now();
    this.heard_ms_ = now;
    const message = JSON.parse(data) as Record<string, unknown>;
    if (typeof message.pong === "number") return this.ponged(now, message.pong, Number(message.now_ms));
    const state = message.state as { now_ms?: number } | undefined;
    if (state && typeof state.now_ms === "number" && this.offset_ms === undefined) this.offset_ms = state.now_ms - now;
    if (!this.connected) {
      this.connected = true;
      this.wait_ms_ = kFirstWait_ms;
      this.listener_.changed();
      this.ping();
    }
    this.listener_.said(message);
  }

  private ping(): void {
    this.pinged_ms_ = performance.now();
    this.say({ ping: this.pinged_ms_ });
  }

  /** The quickest round trip is the most honest one; an old one makes room in time, for clocks drift. */
  private ponged(now: number, sent: number, program_ms: number): void {
    const trip = now - sent;
    if (trip <= this.best_ms_) {
      this.best_ms_ = trip;
      this.offset_ms = program_ms - (sent + now) / 2;
    } else {
      this.best_ms_ += 1;
    }
    if (++this.pings_ < kFirstPings) this.ping();
  }

  private lost(code: number): void {
    this.socket_ = undefined;
    this.connected = false;
    this.listener_.changed();
    if (code === kTokenRefused) return this.listener_.refused();
    setTimeout(() => this.connect(), this.wait_ms_ * (0.5 + Math.random()));
    this.wait_ms_ = Math.min(kLongestWait_ms, 2 * this.wait_ms_);
  }

  private watch(): void {
    const now = performance.now();
    if (this.socket_ && now - this.heard_ms_ > kSilence_ms) {
      const old = this.socket_;
      old.onclose = null;
      old.close();
      return this.lost(1006);
    }
    if (this.connected && now - this.pinged_ms_ > kPing_ms) this.ping();
  }
}
