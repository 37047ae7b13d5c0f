// SPDX-License-Identifier: Apache-2.0
// What the page itself says; the words of places and ways are the sheet's, and come from the program.

const kCatalogue = {
  code_heading: ["The code of your cast", "演员口令"],
  code_hint: ["ten letters and digits", "十位字母和数字"],
  enter: ["Enter", "进入"],
  who_heading: ["Who are you?", "你是谁？"],
  who_hint: ["search: name or number", "搜索：姓名或编号"],
  more: ["{n} more: type more of the name", "还有 {n} 人：请输入更多"],
  nobody: ["nobody is called so", "没有这个人"],
  change: ["Not me", "换人"],
  stand: ["Stand", "站在"],
  walk: ["Walk to", "走到"],
  next: ["Next", "下一个"],
  until_walk: ["counts until you walk", "拍后走"],
  until_there: ["counts to get there", "拍内走到"],
  to_the_end: ["Stay to the end", "站到结束"],
  until_go: ["counts to GO", "拍后开始"],
  hold: ["HOLD", "停住"],
  hold_note: ["Stand where you are.", "原地站好。"],
  wait_go: ["Standby {cue}: wait for GO", "预备 {cue}：等待开始"],
  hold_end: ["HOLD at the end of the set", "段末停住"],
  over: ["The show is over", "演出结束"],
  reset: ["BACK TO PLACES", "回到位置"],
  reset_ready: ["Back to places comes: {cell}", "即将回到位置：{cell}"],
  reset_wait: ["wait for GO", "等待开始"],
  not_heard: ["THE DESK IS NOT HEARD", "收不到控制台"],
  not_heard_note: ["What stood here may be wrong. Follow the lamps and your leaders.", "此前显示可能有误。请看灯光，听从领队。"],
  no_link: ["NO CONNECTION", "连接已断开"],
  other_plan: ["ANOTHER VERSION IS PLAYED", "正在使用另一版本"],
  other_plan_note: ["This page does not have it yet. Follow the lamps and your leaders.", "本页尚无该版本。请看灯光，听从领队。"],
  absent: ["You are marked absent. Tell your leader that you are here.", "你被标记为缺席。请告诉领队你已到。"],
  where: ["Where?", "我在哪？"],
  where_heading: ["Where are you now?", "你现在在哪？"],
  where_hint: ["cell, as D12", "格子，如 D12"],
  ask: ["Find my way", "找路"],
  close: ["Close", "关闭"],
  audience: ["Audience", "观众"],
  asking: ["Looking for a way ...", "正在找路……"],
  join: ["Go at count {count} ({measure})", "第 {count} 拍（{measure}）出发"],
  join_now: ["The show stands: go now, and watch out", "演出暂停：现在走，注意周围"],
  leg: ["{cell}: {way}", "{cell}：{way}"],
  arrive: ["There you are right: {cell}", "到达你的位置：{cell}"],
  here: ["You are where you should be.", "你的位置是对的。"],
  wait: ["WAIT where you are. Ask again at count {count} ({measure}).", "在原地等。第 {count} 拍（{measure}）再问。"],
  aside: ["Somebody walks here. Step aside to {cell} and wait. Ask again at count {count} ({measure}).", "有人要经过。让到 {cell} 等。第 {count} 拍（{measure}）再问。"],
  nowhere: ["No safe way is known from there. Look again where you are; else stand still and wave to your leader.", "没有安全的路。请再确认位置；否则站住并向领队招手。"],
  no_cell: ["Nobody can stand there. Where else?", "那里不能站人。请重选。"],
  held: ["HOLD in the middle of a walk: stand still, and ask when it goes on.", "走动中停住：请站好，继续后再问。"],
  in_reset: ["Everybody walks back to places: wait, and ask when that is over.", "大家正在回位：请等结束后再问。"],
  busy: ["Many ask at once. Try again in a moment.", "询问的人太多，请稍后再试。"],
  unknown_cell: ["There is no such cell.", "没有这个格子。"],
  stale: ["The plan has just changed. Try again.", "方案刚更新，请再试。"],
  centre: ["Centre", "中央"],
  downstage: ["Front centre", "前中"],
  upstage: ["Back centre", "后中"],
  stage_right: ["Stage right side", "右侧"],
  stage_left: ["Stage left side", "左侧"],
  count: ["count", "拍"],
  steps_back: ["Your place", "你的位置"],
  language_name: ["中文", "English"],
  theme: ["Dark / light", "明暗"],
} as const;

export type Word = keyof typeof kCatalogue;
export type Language = "en" | "zh";

let language: Language = "en";

export function set_language(to: Language): void {
  language = to;
}

export function spoken(): Language {
  return language;
}

export function say(word: Word, values: Record<string, string | number> = {}): string {
  const text: string = kCatalogue[word][language === "zh" ? 1 : 0];
  return text.replace(/\{(\w+)\}/g, (place, name: string) => String(name in values ? values[name] : place));
}

/** Both texts of every word: for a test that their places are the same. */
export function catalogue(): Record<string, readonly [string, string]> {
  return kCatalogue;
}

/** Fills data-word (text) and data-hint (placeholder and name). */
export function translate(root: Document): void {
  root.documentElement.lang = language === "zh" ? "zh-CN" : "en";
  root.querySelectorAll<HTMLElement>("[data-word]").forEach((part) => (part.textContent = say(part.dataset.word as Word)));
  root.querySelectorAll<HTMLInputElement>("[data-hint]").forEach((part) => {
    part.placeholder = say(part.dataset.hint as Word);
    part.setAttribute("aria-label", part.placeholder);
  });
}
