// SPDX-License-Identifier: Apache-2.0
// The connection: says hello, takes what comes, and comes back by itself when it is lost.

/** What the page gets to know. */
export interface Listener {
  opened(): void;
  said(message: Record<string, unknown>): void;
  frame(bytes: ArrayBuffer): void;
  closed(code: number): void;
}

const kSilence_ms = 2500; // the program speaks once a second at least
const kWatch_ms = 500;
const kFirstWait_ms = 250;
const kLongestWait_ms = 4000;
const kPing_ms = 2000;
export const kTokenWanted = 4401;

export class Link {
  private socket_?: WebSocket;
  private open_ = false;
  private wait_ms_ = kFirstWait_ms;
  private heard_ms_ = 0;
  private tried_ms_ = 0;
  private watched_ms_ = 0;
  private pinged_ms_ = 0;
  /** From a ping to its answer; undefined: not known. */
  round_trip_ms: number | undefined;
  token: string | undefined;

  constructor(private readonly listener_: Listener, private readonly name_: () => string) {
    setInterval(() => this.watch(), kWatch_ms);
  }

  connect(): void {
    this.socket_?.close();
    const address = new URL("ws", location.href);
    address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
    const socket = new WebSocket(address.href);
    this.socket_ = socket;
    this.tried_ms_ = performance.now();
    socket.binaryType = "arraybuffer";
    socket.onopen = () => socket.send(JSON.stringify({ hello: { name: this.name_(), ...(this.token ? { token: this.token } : {}) } }));
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => this.heard(event.data);
    socket.onclose = (event) => {
      if (this.socket_ === socket) this.lost(event.code);
    };
  }

  /** @return false: there is no connection */
  say(message: Record<string, unknown>): boolean {
    if (!this.open_ || this.socket_?.readyState !== WebSocket.OPEN) return false;
    this.socket_.send(JSON.stringify(message));
    return true;
  }

  connected(): boolean {
    return this.open_;
  }

  /** Page time of the last word of the program. */
  heard_ms(): number {
    return this.heard_ms_;
  }

  private heard(data: string | ArrayBuffer): void {
    this.heard_ms_ = performance.now();
    if (typeof data !== "string") return this.listener_.frame(data);
    const message = JSON.parse(data) as Record<string, unknown>;
    if ("pong" in message) {
      this.round_trip_ms = performance.now() - Number(message.pong);
      return;
    }
    if ("welcome" in message) {
      this.open_ = true;
      this.wait_ms_ = kFirstWait_ms;
      this.listener_.opened();
    }
    this.listener_.said(message);
  }

  private lost(code: number): void {
    this.open_ = false;
    this.socket_ = undefined;
    this.round_trip_ms = undefined;
    this.listener_.closed(code);
    if (code === kTokenWanted) return; // somebody has to type one
    setTimeout(() => this.connect(), this.wait_ms_);
    this.wait_ms_ = Math.min(kLongestWait_ms, 2 * this.wait_ms_);
  }

  private watch(): void {
    const now = performance.now();
    const stalled = now - this.watched_ms_ > 2 * kWatch_ms; // the page itself did not run: what came meanwhile is still to be read
    this.watched_ms_ = now;
    if (stalled) return;
    if (this.socket_ && now - Math.max(this.heard_ms_, this.tried_ms_) > kSilence_ms) {
      // A dead network closes nothing by itself.
      const old = this.socket_;
      old.onclose = null;
      old.close();
      return this.lost(1006);
    }
    if (this.open_ && now - this.pinged_ms_ > kPing_ms) {
      this.pinged_ms_ = now;
      this.say({ ping: Math.round(now) });
    }
  }
}
