// SPDX-License-Identifier: Apache-2.0
// What the GPU runs. People are placed by it, from their marks and the time; a frame sends it a few numbers.

import { ArrayTexture } from "./gl";

const kHead = `#version 300 es
precision highp float;
precision highp int;
precision highp isampler2D;
precision highp usampler2D;
`;

/** Marks: time in ms, cell. Centres: m. A person's marks begin at track.x and are track.y. */
const kPlaces = `
uniform isampler2D marks;
uniform sampler2D centres;
ivec2 texel(int i) { return ivec2(i % ${ArrayTexture.kTexels}, i / ${ArrayTexture.kTexels}); }
ivec2 mark(int i) { return texelFetch(marks, texel(i), 0).xy; }
vec2 centre(int cell) { return texelFetch(centres, texel(cell), 0).xy; }
int mark_before(int first, int many, int time_ms) {
  int low = first, high = first + many;
  for (int k = 0; k < 32 && high - low > 1; ++k) {
    int middle = (low + high) / 2;
    if (mark(middle).x <= time_ms) low = middle; else high = middle;
  }
  return low;
}
vec2 between(int i, int last, int time_ms) {
  ivec2 a = mark(i);
  if (i >= last || time_ms <= a.x) return centre(a.y);
  ivec2 b = mark(i + 1);
  return mix(centre(a.y), centre(b.y), clamp(float(time_ms - a.x) / float(b.x - a.x), 0.0, 1.0));
}
`;

const kView = `
uniform mat4 view;
uniform vec2 viewport;   // device pixels
uniform float focal;     // device pixels of a metre where w is 1
const vec2 corners[4] = vec2[](vec2(-1, -1), vec2(1, -1), vec2(-1, 1), vec2(1, 1));
`;

/** Cells of the floor: where nobody stands, wings, blocked. */
export const cells_vertex = `${kHead}${kPlaces}${kView}
in uint flags;
uniform float half_m;
uniform float turn;      // 1: triangles, every second one points downstage
out vec2 at;
flat out uint kind;
flat out float down;
out float px;
void main() {
  vec2 corner = corners[gl_VertexID];
  kind = flags & 3u;
  down = float(flags >> 7u);
  at = corner;
  gl_Position = view * vec4(centre(gl_InstanceID) + corner * half_m, 0, 1);
  px = half_m * focal / gl_Position.w;
  if (kind == 0u && px < 2.0) gl_Position = vec4(2, 2, 2, 1);   // its rim would not be seen
}`;

export const cells_fragment = `${kHead}
in vec2 at;
flat in uint kind;
flat in float down;
in float px;
uniform vec3 line, wing, blocked;
uniform int shape;       // 4: squares, 6: hexagons, 3: triangles
out vec4 colour;
void main() {
  float edge;            // 1 at the rim
  if (shape == 4) edge = max(abs(at.x), abs(at.y));
  else if (shape == 6) edge = max(abs(at.x), dot(abs(at), vec2(0.5, 0.8660254)));
  else { float y = down > 0.5 ? -at.y : at.y; edge = max(-y * 2.0, abs(at.x) * 1.7320508 + y); }
  if (edge > 1.0) discard;
  float rim = smoothstep(1.0 - 1.6 / px, 1.0 - 0.6 / px, edge) * clamp((px - 2.0) / 4.0, 0.0, 1.0);
  vec4 ground = vec4(0);
  if (kind == 1u) {      // blocked: hatched, not coloured alone
    float stripe = step(0.5, fract((at.x + at.y) * 1.5));
    ground = vec4(blocked, px > 3.0 ? 0.35 + 0.5 * stripe : 0.7);
  } else if (kind == 2u) ground = vec4(wing, 0.6);
  colour = mix(ground, vec4(line, 0.7), rim);
}`;

/**
 * Lamps: what they were last confirmed to show. A node has a layer of `shown` (the looks of one switch) and flags:
 * 1 silent, 2 not right. 255: nothing confirmed yet.
 */
export const lamps_vertex = `${kHead}${kPlaces}${kView}
precision highp usampler2DArray;
in uvec2 lamp;           // cell, channel: 32 of each node
uniform usampler2D nodes;
uniform usampler2DArray shown;
uniform sampler2D looks; // 256: colour with brightness, effect in alpha
uniform int planned;     // a layer: what the plan says; -1: what is confirmed
uniform float half_m;
uniform float least_px;
uniform float seconds;
out vec2 at;
flat out vec3 light;
flat out uint state;
out float px;
void main() {
  vec2 corner = corners[gl_VertexID];
  uvec2 node = texelFetch(nodes, texel(int(lamp.y / 32u)), 0).xy;
  int layer = int(node.x);
  state = node.y;
  if (planned >= 0) { layer = planned; state = 0u; }
  uint index = layer == 255 ? 0u : texelFetch(shown, ivec3(texel(int(lamp.y)), layer), 0).x;
  vec4 look = texelFetch(looks, ivec2(int(index), 0), 0);
  int effect = int(look.a * 255.0 + 0.5);
  float on = 1.0;        // as lamps do: docs/wire-protocol.md
  if (effect == 1 || effect == 4) on = step(fract(seconds), 0.5);
  else if (effect == 2) on = 0.6 + 0.4 * sin(3.14159265 * seconds);
  else if (effect == 3) { float f = fract(seconds / 1.2) * 1.2; on = max(step(f, 0.2), step(0.4, f) * step(f, 0.6)); }
  light = look.rgb * mix(0.25, 1.0, on);
  vec4 p = view * vec4(centre(int(lamp.x)), 0, 1);
  px = max(half_m * focal / p.w, least_px);
  bool dark = look.r + look.g + look.b == 0.0 && state == 0u;
  at = corner;
  // On the floor; from far as a point that can still be seen.
  vec4 lies = half_m * focal / p.w > least_px ? view * vec4(centre(int(lamp.x)) + corner * half_m, 0, 1) : p + vec4(corner * px * 2.0 / viewport * p.w, 0, 0);
  gl_Position = dark ? vec4(2, 2, 2, 1) : lies;
}`;

export const lamps_fragment = `${kHead}
in vec2 at;
flat in vec3 light;
flat in uint state;
in float px;
uniform vec3 wrong, ink;
out vec4 colour;
void main() {
  float edge = max(abs(at.x), abs(at.y));
  // A square frame: people are round.
  vec4 lamp = edge > 0.74 ? vec4(light, 0.95) : vec4(light, 0.22);
  if (state != 0u) {     // a cross over what it was last known to show; thicker for a silent one
    float width = (state & 1u) != 0u ? 0.24 : 0.13;
    float cross_m = min(abs(at.x - at.y), abs(at.x + at.y));
    // From far crosses would hide the people.
    if (px < 5.0) lamp = vec4(wrong, 0.5);
    else lamp = edge > 0.82 ? vec4(wrong, 1) : cross_m < width + 0.7 / px ? vec4(ink, 0.9) : vec4(light, 0.35);
  }
  colour = lamp;
}`;

/** People, at an instant; as ghosts: where they will be at another one. */
export const people_vertex = `${kHead}${kPlaces}${kView}
in uvec2 track;
in uvec2 who;            // colour, 1 selected | 2 absent | 4 away from the picture
uniform int time_ms;
uniform float radius_m;
uniform float least_px;
uniform float stand_m;   // height in the view from the audience; 0: from above
uniform int ghost;       // 1: only who stands elsewhere then
uniform int now_ms;
uniform sampler2D groups;
out vec2 at;
flat out vec3 cloth;
flat out uvec2 what;
out float px;
void main() {
  vec2 corner = corners[gl_VertexID];
  int first = int(track.x), last = first + int(track.y) - 1;
  vec2 here = between(mark_before(first, int(track.y), time_ms), last, time_ms);
  vec4 p = view * vec4(here, 0, 1);
  px = max(radius_m * focal / p.w, least_px);
  if ((who.y & 1u) != 0u) px *= 1.5;
  vec2 reach = corner * px;
  if (stand_m > 0.0) {
    float high = max(stand_m * focal / p.w, 2.2 * px);
    reach = vec2(corner.x * px, (corner.y + 1.0) * 0.5 * high);
  }
  at = corner;
  what = who;
  cloth = texelFetch(groups, ivec2(int(who.x), 0), 0).rgb;
  gl_Position = p + vec4(reach * 2.0 / viewport * p.w, 0, 0);
  if (ghost == 1) {
    if (radius_m * focal / p.w > least_px) gl_Position = view * vec4(here + corner * radius_m, 0, 1);
    vec2 now = between(mark_before(first, int(track.y), now_ms), last, now_ms);
    if (distance(now, here) < 0.05 * radius_m) gl_Position = vec4(2, 2, 2, 1);
  }
}`;

export const people_fragment = `${kHead}
in vec2 at;
flat in vec3 cloth;
flat in uvec2 what;
in float px;
uniform float stand_m;
uniform int ghost;
uniform vec3 edge_colour, selected;
uniform float seconds;
out vec4 colour;
void main() {
  float r;
  if (stand_m > 0.0) {   // a capsule: a head above a body
    vec2 p = vec2(at.x, at.y);
    float head = length(vec2(p.x * 1.15, (p.y - 0.72) * 3.6)) / 0.95;
    float body = max(abs(p.x) / 0.9, abs(p.y + 0.22) / 0.74);
    r = min(head, body);
  } else r = length(at);
  if (r > 1.0) discard;
  bool chosen = (what.y & 1u) != 0u;
  if (ghost == 1) {
    if (r < 1.0 - max(0.22, 1.2 / px)) discard;
    colour = vec4(mix(cloth, selected, 0.35), 0.65);
    return;
  }
  vec3 c = cloth;
  if ((what.y & 4u) != 0u) c *= 0.55;
  if (px > 3.5) {        // groups differ by pattern, too
    uint pattern = what.x & 3u;
    bool light = pattern == 1u ? abs(at.y) < 0.22 : pattern == 2u ? r < 0.36 : pattern == 3u ? abs(at.x) < 0.22 : false;
    if (light) c = mix(c, vec3(dot(c, vec3(0.3, 0.6, 0.1)) > 0.45 ? 0.05 : 0.95), 0.8);
  }
  if ((what.y & 2u) != 0u) {
    if (min(abs(at.x - at.y), abs(at.x + at.y)) > 0.3 && r < 0.85) discard;
    c = vec3(0.85);
  }
  if (chosen && r > 0.72) c = selected;
  else if (px > 3.0 && r > 1.0 - 1.5 / px) c = edge_colour;
  colour = vec4(c, 1);
}`;

/** Ways: stretch `gl_InstanceID % stretches` of a person after `from_ms`, cut at `until_ms`. */
export const ways_vertex = `${kHead}${kPlaces}${kView}
in uvec2 track;
in uvec2 who;
uniform int stretches, from_ms, until_ms;
uniform float width_px;
uniform sampler2D groups;
flat out vec3 cloth;
out float along;         // device pixels from the beginning of the stretch
flat out float later;    // 0: this stretch, 1: the last one
void main() {
  vec2 corner = corners[gl_VertexID];
  int k = gl_InstanceID % stretches;
  int first = int(track.x), last = first + int(track.y) - 1;
  int i = mark_before(first, int(track.y), from_ms) + k;
  gl_Position = vec4(2, 2, 2, 1);
  if (i >= last) return;
  int begins = max(mark(i).x, from_ms), ends = min(mark(i + 1).x, until_ms);
  if (begins >= ends) return;
  vec4 a = view * vec4(between(i, last, begins), 0, 1);
  vec4 b = view * vec4(between(i, last, ends), 0, 1);
  if (a.w < 0.01 || b.w < 0.01) return;
  vec2 run = (b.xy / b.w - a.xy / a.w) * viewport * 0.5;
  float length_px = length(run);
  if (length_px < 0.3) return;
  vec2 aside = vec2(-run.y, run.x) / length_px;
  vec4 end = corner.x < 0.0 ? a : b;
  cloth = texelFetch(groups, ivec2(int(who.x), 0), 0).rgb;
  along = corner.x < 0.0 ? 0.0 : length_px;
  later = float(k) / float(stretches);
  gl_Position = end + vec4(aside * corner.y * width_px / viewport * end.w, 0, 0);
}`;

export const ways_fragment = `${kHead}
flat in vec3 cloth;
in float along;
flat in float later;
uniform float alpha, dash_px;
uniform vec4 ink;        // alpha 0: the group's colour
out vec4 colour;
void main() {
  if (dash_px > 0.0 && fract(along / dash_px) > 0.6) discard;
  colour = vec4(mix(cloth, ink.rgb, ink.a), alpha * (1.0 - 0.7 * later));
}`;
