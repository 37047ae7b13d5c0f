// SPDX-License-Identifier: Apache-2.0
// Times as people at a desk read them. Pure.

/** "1:23.5"; with hours "1:02:03.5". Cut, not rounded: it never shows an instant that has not come. */
export function clock_text(time_s: number): string {
  if (!Number.isFinite(time_s)) return "–";
  const tenths = Math.floor(Math.abs(time_s) * 10 + 1e-6);
  const minutes = Math.floor(tenths / 600);
  const rest = ((tenths % 600) / 10).toFixed(1).padStart(4, "0");
  const sign = time_s < 0 && tenths > 0 ? "−" : "";
  if (minutes < 60) return `${sign}${minutes}:${rest}`;
  return `${sign}${Math.floor(minutes / 60)}:${String(minutes % 60).padStart(2, "0")}:${rest}`;
}

/**
 * What is left until an instant: whole seconds that count down to 0, tenths in the last ten ("3.4"), minutes above two.
 * Rounded up, so that 0 is shown when the instant has come and not before.
 */
export function countdown_text(left_s: number): string {
  if (!Number.isFinite(left_s)) return "";
  const left = Math.max(0, left_s);
  if (left <= 10) return (Math.ceil(left * 10 - 1e-6) / 10).toFixed(1);
  const whole = Math.ceil(left - 1e-6);
  if (whole < 120) return String(whole);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
}

/** hh:mm:ss:ff of a time without drop-frame counting. @param fps whole frames a second */
export function timecode_text(time_s: number, fps: number): string {
  const frames = Math.floor(Math.max(0, time_s) * fps + 1e-6);
  const two = (value: number) => String(value).padStart(2, "0");
  const seconds = Math.floor(frames / fps);
  return `${two(Math.floor(seconds / 3600))}:${two(Math.floor(seconds / 60) % 60)}:${two(seconds % 60)}:${two(frames % fps)}`;
}

/** A count to a tenth, cut: "17.2" or "17". */
export function count_text(count: number): string {
  return Number.isFinite(count) ? String(Math.floor(count * 10 + 1e-6) / 10) : "–";
}
