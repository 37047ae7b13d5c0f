// SPDX-License-Identifier: Apache-2.0
// What the page says, in English and Chinese, with the words of the paper (app/paper/words.cpp). Pure but for `translate`.

const kCatalogue = {
  no_emergency_stop: ["HOLD is no emergency stop: it only changes lamps. Watch the stage, and be heard.", "HOLD 不是急停：它只改变灯光。请看着舞台，并能喊停。"],
  not_connected: ["NOT CONNECTED", "连接已断开"],
  lost_note: ["The show may be going on. What is drawn here is old. Trying again.", "演出可能仍在继续。画面已过时，正在重连。"],
  lost_since: ["last heard of {time}, {seconds} s ago", "最后收到 {time}，{seconds} 秒前"],
  standby: ["Standby", "预备"],
  go: ["GO", "走"],
  hold: ["HOLD", "停住"],
  hold_end: ["Hold at the end", "在段末停"],
  run_on: ["Run on", "不停"],
  back: ["Back", "退回"],
  top: ["Top", "从头"],
  step: ["One count", "一拍"],
  jump: ["Jump …", "跳到…"],
  loop: ["Loop …", "循环…"],
  loop_off: ["Loop off", "结束循环"],
  slower: ["Slower", "慢"],
  faster: ["Faster", "快"],
  note: ["Note …", "备注…"],
  placed: ["All are in place", "人已到位"],
  cancel: ["Cancel", "取消"],
  send: ["Say", "发出"],
  key_space: ["Space", "空格"],
  stands: ["Stands", "静止"],
  holds: ["HOLD", "停住"],
  counts_in: ["Counts in", "预备拍"],
  runs: ["Runs", "进行中"],
  resets: ["Reset move", "复位走位"],
  reset_held: ["HOLD in the reset move", "复位走位中停住"],
  finished: ["The show is over", "演出结束"],
  waiting: ["Waiting for the program", "等待程序"],
  in_cue: ["in cue {number} {name}", "第 {number} 场 {name}"],
  runs_cue: ["cue {number} {name}", "第 {number} 场 {name}"],
  the_end: ["the end", "结束"],
  until_next: ["s until it", "秒后"],
  until_go: ["s: cue {cue} begins", "秒后：第 {cue} 场开始"],
  until_end: ["s until the end", "秒后结束"],
  by_itself: ["s, then by itself", "秒后自动接续"],
  holds_at_end: ["HOLD at the end of the set", "将在段末停住"],
  goes_on: ["GO goes on with cue {number}", "按「走」继续第 {number} 场"],
  against: ["HELD BY {names}", "被 {names} 阻止"],
  gates: ["Gates", "门控"],
  reset_planned: ["the reset move is being planned", "正在计算复位走位"],
  reset_ready: ["GO lights the reset move to {time}. Are people where they should be?", "按「走」点亮到 {time} 的复位走位。人都站对了吗？"],
  reset_walks_on: ["GO: people walk on to the end of the set, then the reset move to {time}", "按「走」：走完本段，再复位到 {time}"],
  reset_runs: ["people walk to where they stand at {time}", "人走到 {time} 的位置"],
  reset_goes_on: ["GO goes on with the way to {time}", "按「走」继续走到 {time} 的位置"],
  reset_impossible: ["NO RESET MOVE: send people by word of mouth, then “All are in place”", "没有复位走位：请口头安排，然后按「人已到位」"],
  loops: ["loop {from} – {to}", "循环 {from} – {to}"],
  refused: ["{order} refused: {why}", "{order} 被拒绝：{why}"],
  seat_needed: ["take the desk first", "请先接管控制台"],
  no_link: ["there is no connection", "没有连接"],
  take_seat: ["Take the desk", "接管"],
  leave_seat: ["Leave the desk", "交出"],
  seat_mine: ["You lead", "由你指挥"],
  seat_other: ["{name} leads", "{name} 指挥"],
  seat_empty: ["Nobody leads", "无人指挥"],
  view_only: ["view only", "只看"],
  link: ["{ms} ms", "{ms} 毫秒"],
  connecting: ["connecting", "连接中"],
  theme: ["Light", "明暗"],
  help: ["Keys", "按键"],
  close: ["Close", "关闭"],
  alarms: ["Alarms", "警报"],
  seen: ["Seen", "已知"],
  readiness: ["Readiness", "准备情况"],
  desk: ["Desk", "控制台"],
  transport: ["Orders", "口令"],
  order_name: ["Order in words", "文字口令"],
  order_hint: ["jump cue 12 · loop counts 17 33 · help", "jump cue 12 · loop counts 17 33 · help"],
  cue_list: ["Cue list", "场次表"],
  stage: ["Stage", "舞台"],
  stage_name: ["The stage from above, audience below", "舞台俯视图，观众在下"],
  views: ["What is drawn", "显示"],
  front: ["Audience", "观众视角"],
  people: ["People", "人"],
  markers: ["Markers", "灯"],
  next_form: ["Next", "下一队形"],
  ways: ["Ways", "路线"],
  whole_stage: ["The whole stage", "全场"],
  closer: ["Closer", "放大"],
  farther: ["Farther", "缩小"],
  audience: ["audience", "观众"],
  stage_right: ["stage right", "舞台右"],
  stage_left: ["stage left", "舞台左"],
  looking_at: ["Looking at", "正在看"],
  not_sent: ["It is not sent to the markers.", "不会发给灯。"],
  now: ["Back to now", "回到现在"],
  legend: ["● people  ○ next  □ marker as confirmed  ☒ not right or silent  ▨ blocked", "● 人  ○ 下一位置  □ 已确认的灯  ☒ 不对或无应答  ▨ 不可站"],
  legend_planned: ["● people  ○ next  □ marker as planned  ▨ blocked", "● 人  ○ 下一位置  □ 计划中的灯  ▨ 不可站"],
  side: ["Health, search, log", "状态、查找、日志"],
  health: ["Health", "状态"],
  find: ["Find", "查找"],
  log: ["Log", "日志"],
  bus: ["Bus", "总线"],
  nodes_right: ["Right", "正常"],
  lateness: ["Worst late", "最迟"],
  retries: ["Retries", "重发"],
  not_right: ["Not right", "不正常"],
  all_right: ["All {n} nodes are confirmed right", "{n} 个节点全部确认正常"],
  some_wrong: ["{n} of {all} markers not right: {list}", "{all} 个灯中 {n} 个不正常：{list}"],
  unverified: ["{n} nodes cannot be read back: unverified", "{n} 个节点无法回读：未验证"],
  no_rig: ["This show has no buses", "本演出没有总线"],
  node_silent: ["silent", "无应答"],
  node_quarantined: ["quarantined", "已隔离"],
  node_wrong: ["not confirmed", "未确认"],
  node_markers: ["{n} markers", "{n} 个灯"],
  and_more: ["and {n} more", "还有 {n} 个"],
  more_facts: ["More", "更多"],
  connected: ["Connected", "已连接"],
  pair_view: ["Code to view", "只看配对码"],
  pair_operate: ["Code to operate", "操作配对码"],
  code: ["{code}, good for {seconds} s", "{code}，{seconds} 秒内有效"],
  search_name: ["Find people, groups, cells, nodes", "查找人、组、格、节点"],
  search_hint: ["name, D12, 100-200, group, node", "姓名、D12、100-200、组、节点"],
  nobody: ["Nobody is called so", "没有找到"],
  group: ["Group", "组"],
  cell: ["Place", "位置"],
  next_place: ["Next place", "下一个位置"],
  marker: ["Marker", "灯"],
  absent: ["absent", "缺席"],
  in_seconds: ["{cell}, in {seconds} s", "{cell}，{seconds} 秒后"],
  stays: ["stays to the end", "停到结束"],
  measure_beat: ["measure:beat", "小节:拍"],
  count: ["count", "拍"],
  time: ["time", "时间"],
  internal: ["own clock", "内部时钟"],
  locked: ["locked", "已锁定"],
  at_most: ["at most {most} %", "最多 {most} %"],
  scrub_name: ["Look at another time; nothing is sent", "查看其他时刻；不会发出"],
  arm: ["Arm GO", "启用「走」"],
  not_armed: ["GO is not armed", "「走」未就绪"],
  scope: ["scope: {scope}", "权限：{scope}"],
  markers_word: ["{n} markers on {nodes} nodes", "{n} 个灯，{nodes} 个节点"],
  language_name: ["中文", "English"],
  join_note: ["Type the eight digits of a pairing code, or the token.", "请输入八位配对码或令牌。"],
  join_name: ["Code or token", "配对码或令牌"],
  escape_again: ["Esc again: HOLD", "再按 Esc：停住"],
  key_go: ["GO: the standby cue, or what was held goes on", "走：下一场，或继续"],
  key_hold: ["HOLD at once (also H)", "立刻停住（或 H）"],
  key_end: ["HOLD at the end of the set, and that taken back", "在段末停住；再按取消"],
  key_back: ["back, to the top", "退回、从头"],
  key_step: ["one count, counted in as a GO is", "一拍（与“走”一样先数拍）"],
  key_mute: ["solo, mute groups, and that taken back", "独练、静音分组；再按取消"],
  key_choose: ["choose a cue in the list; Enter asks for the jump", "在表中选场；回车跳到"],
  key_ask: ["jump, loop, note, or any order", "跳到、循环、备注、任意口令"],
  key_tempo: ["tempo, tapped", "速度、点拍"],
  key_reset: ["people are in place; cancel the jump", "人已到位；取消跳转"],
  key_ok: ["an input that was stuck counts again; all alarms seen", "卡住的按键恢复；警报已知"],
  key_view: ["from the audience; what is drawn; the whole stage", "观众视角；显示内容；全场"],
  key_find: ["find people", "找人"],
  key_pan: ["wheel, drag, two fingers: zoom and move; click: who is it", "滚轮、拖动、双指：缩放与移动；点击：是谁"],
  no_webgl: ["The stage cannot be drawn: {why}", "无法绘制舞台：{why}"],
  show_failed: ["The show could not be fetched: {why}", "无法取得演出：{why}"],
  timecode_lost: ["lost", "丢失"],
} as const;

export type Word = keyof typeof kCatalogue;
export type Language = "en" | "zh";

let language: Language = "en";

export function set_language(to: Language): void {
  language = to;
}

export function is_word(text: string): text is Word {
  return Object.prototype.hasOwnProperty.call(kCatalogue, text);
}

/** The text of a word, with its places {name} filled. */
export function say(word: Word, values: Record<string, string | number> = {}): string {
  const text: string = kCatalogue[word][language === "zh" ? 1 : 0];
  return text.replace(/\{(\w+)\}/g, (place, name: string) => String(values[name] ?? place));
}

/** Both texts of every word: for a test that their places are the same. */
export function catalogue(): Record<string, readonly [string, string]> {
  return kCatalogue;
}

/** Fills data-word (text), data-name (accessible name) and data-hint (placeholder). */
export function translate(root: Document): void {
  root.documentElement.lang = language === "zh" ? "zh-CN" : "en";
  for (const part of root.querySelectorAll<HTMLElement>("[data-word]")) part.textContent = say(part.dataset.word as Word);
  for (const part of root.querySelectorAll<HTMLElement>("[data-name]")) {
    const name = say(part.dataset.name as Word);
    part.setAttribute("aria-label", name);
    if (part.id === "language") part.textContent = name;
  }
  for (const part of root.querySelectorAll<HTMLInputElement>("[data-hint]")) part.placeholder = say(part.dataset.hint as Word);
}
