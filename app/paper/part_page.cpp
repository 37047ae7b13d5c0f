// SPDX-License-Identifier: Apache-2.0
#include "app/paper/part_page.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "app/html_text.hpp"
#include "app/paper/drawn_floor.hpp"

namespace footlight::app {
namespace {

constexpr const char* kHead =
    R"(<meta charset="utf-8"><meta name="viewport" content="width=device-width,initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none';style-src 'unsafe-inline';script-src 'unsafe-inline'">
)";

constexpr const char* kStyle = R"(<style>
:root{color-scheme:light;--paper:#fff;--ink:#111;--faint:#555;--line:#bbb;--mark:#b34700;--go:#0060a8}
@media (prefers-color-scheme:dark){:root:not([data-light=light]){color-scheme:dark;--paper:#000;--ink:#f4f4f4;--faint:#aaa;--line:#444;--mark:#ff9f4a;--go:#6cb8ff}}
:root[data-light=dark]{color-scheme:dark;--paper:#000;--ink:#f4f4f4;--faint:#aaa;--line:#444;--mark:#ff9f4a;--go:#6cb8ff}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);font:clamp(18px,4.6vw,26px)/1.3 "DejaVu Sans",Verdana,"Noto Sans CJK SC",sans-serif}
header,footer{padding:.4em .7em;overflow-wrap:anywhere}
header{display:flex;gap:.6em;align-items:center;border-bottom:1px solid var(--line)}
header b{flex:1}header i{font-style:normal;color:var(--faint);font-size:.75em}
footer{color:var(--faint);font-size:.6em;padding-bottom:5.5em}
main{max-width:30em;margin:auto;padding:0 .7em;touch-action:manipulation}
section{padding:.3em 0;border-bottom:1px solid var(--line)}
.js section{display:none;border:0}.js section.on{display:block}
p{margin:.25em 0;overflow-wrap:anywhere}
h2{font-size:1em;margin:.3em 0;color:var(--mark)}
.count b{font-size:2.8em;line-height:1}.count i{font-style:normal;color:var(--faint);margin-left:.5em}
.cell b{font-size:2em;line-height:1.1;margin-right:.4em}
.way{display:flex;gap:.6em;align-items:center;color:var(--go);font-size:1.15em}.way svg{flex:none;width:3.2em;height:3.2em}
.near{display:grid;grid-template:"a a a" auto "l y r" auto/1fr auto 1fr;gap:.1em .6em;text-align:center;border:1px solid var(--line);border-radius:.4em;padding:.3em;overflow-wrap:anywhere}
.near .a{grid-area:a}.near .l{grid-area:l;text-align:right}.near .y{grid-area:y;color:var(--mark)}.near .r{grid-area:r;text-align:left}.near .n{grid-column:1/4;color:var(--faint)}
.front{color:var(--faint);font-size:.6em;text-align:center;text-transform:uppercase;letter-spacing:.3em}
.less{color:var(--faint);font-size:.85em}
.maps{display:flex;gap:.6em;font-size:.6em;color:var(--faint);text-align:center}.maps figure{margin:0;flex:1}.maps svg{width:100%;height:38vw;max-height:12em}
nav{position:fixed;left:0;right:0;bottom:0;display:none;background:var(--paper);border-top:1px solid var(--line);align-items:center}
.js nav{display:flex}nav span{flex:1;text-align:center;color:var(--faint)}
button{font:inherit;background:none;color:inherit;border:0;padding:.35em .6em;min-width:2.4em}
nav button{flex:2;font-size:1.6em;padding:.15em}button:disabled{opacity:.25}
li{margin:.4em 0}a{color:var(--go)}
</style>
)";

// Maps: x to the right is stage right, y down is upstage: as who faces the audience sees it. Numbers alone go into
// them. The place that is shown stands in the address, so that a page that is opened again is where it was.
constexpr const char* kScript = R"js(<script>
'use strict';(()=>{
const root=document.documentElement,body=document.body,$=s=>document.querySelector(s);
const all=[...document.querySelectorAll('section')],floor=$('main').dataset.floor.split(' ').map(Number);
const pitch=floor[4],at=s=>({x:-s.dataset.x,y:+s.dataset.y});
let k=0;
const keep=(to,value)=>{try{to(value)}catch(e){}};
const line=(a,b,c,w,d)=>`<line x1="${a.x}" y1="${a.y}" x2="${b.x}" y2="${b.y}" stroke="var(--${c})" stroke-width="${w}" ${d?`stroke-dasharray="${d}"`:''}/>`;
const map=(i,box)=>{
  const here=at(all[i]),u=Math.max(box.w,box.h)/100,o=[];
  o.push(`<rect x="${-floor[2]}" y="${floor[1]}" width="${floor[2]-floor[0]}" height="${floor[3]-floor[1]}" fill="none" stroke="var(--line)" stroke-width="${u}"/>`);
  o.push(line({x:0,y:floor[1]},{x:0,y:floor[3]},'mark',u/2));
  o.push(line({x:-floor[2],y:floor[1]},{x:-floor[0],y:floor[1]},'ink',1.5*u));
  if(i>0){const b=at(all[i-1]);o.push(line(b,here,'faint',u,`${3*u} ${2*u}`),`<circle cx="${b.x}" cy="${b.y}" r="${2.5*u}" fill="none" stroke="var(--faint)" stroke-width="${u}"/>`)}
  if(i+1<all.length){const n=at(all[i+1]),dx=n.x-here.x,dy=n.y-here.y,l=Math.hypot(dx,dy);
    if(l>0){const ux=dx/l,uy=dy/l,s=Math.min(8*u,l),p=(a,b)=>`${n.x-a*ux-b*uy},${n.y-a*uy+b*ux}`;
      o.push(line(here,{x:n.x-s*ux/2,y:n.y-s*uy/2},'go',2*u),`<polygon points="${p(0,0)} ${p(s,s/2)} ${p(s,-s/2)}" fill="var(--go)"/>`)}}
  o.push(`<circle cx="${here.x}" cy="${here.y}" r="${3.2*u}" fill="var(--ink)"/>`);
  return `<svg role="img" viewBox="${box.x} ${box.y} ${box.w} ${box.h}">${o.join('')}</svg>`};
const whole=()=>{const m=pitch;return{x:-floor[2]-m,y:floor[1]-m,w:floor[2]-floor[0]+2*m,h:floor[3]-floor[1]+2*m}};
const around=i=>{const s=[at(all[i])];if(i+1<all.length)s.push(at(all[i+1]));else if(i>0)s.push(at(all[i-1]));
  const x=s.map(p=>p.x),y=s.map(p=>p.y),l=Math.min(...x),r=Math.max(...x),t=Math.min(...y),b=Math.max(...y);
  const h=Math.max(2.5*pitch,.62*Math.max(r-l,b-t));return{x:(l+r)/2-h,y:(t+b)/2-h,w:2*h,h:2*h}};
const show=n=>{k=Math.max(0,Math.min(all.length-1,n));
  all.forEach((s,i)=>s.classList.toggle('on',i===k));
  const maps=all[k].querySelectorAll('figure div');
  if(maps.length&&!maps[0].firstChild){maps[0].innerHTML=map(k,around(k));maps[1].innerHTML=map(k,whole())}
  $('#n').textContent=(k+1)+' / '+all.length;$('#back').disabled=k===0;$('#on').disabled=k===all.length-1;
  keep(h=>history.replaceState(null,'',h),'#'+(k+1));scrollTo(0,0)};
const from=()=>{const n=parseInt(location.hash.slice(1),10);show(n>0?n-1:0)};
$('#on').onclick=()=>show(k+1);$('#back').onclick=()=>show(k-1);
$('main').onclick=e=>show(e.clientX<innerWidth/3?k-1:k+1);
addEventListener('keydown',e=>{const step={ArrowRight:1,ArrowDown:1,PageDown:1,' ':1,Enter:1,ArrowLeft:-1,ArrowUp:-1,PageUp:-1,Backspace:-1}[e.key];
  if(e.target.tagName==='BUTTON'&&(e.key===' '||e.key==='Enter')||e.ctrlKey||e.metaKey||e.altKey)return;
  if(step){e.preventDefault();show(k+step)}else if(e.key==='Home'){e.preventDefault();show(0)}else if(e.key==='End'){e.preventDefault();show(all.length-1)}});
addEventListener('hashchange',from);
$('#light').onclick=()=>{const dark=root.dataset.light?root.dataset.light==='dark':matchMedia('(prefers-color-scheme:dark)').matches;
  root.dataset.light=dark?'light':'dark';keep(v=>localStorage.setItem('light',v),root.dataset.light)};
keep(()=>{const v=localStorage.getItem('light');if(v==='dark'||v==='light')root.dataset.light=v});
body.classList.add('js');from();
})();</script>
)js";

long centimetres(double metres) { return std::lround(100 * metres); }

std::string paragraph(const char* kind, const std::string& words) {
  return words.empty() ? "" : fmt::format("<p class=\"{}\">{}</p>\n", kind, escaped(words));
}

/// An arrow that points where to walk, up for forward. @param walk not zero
std::string arrow(Point walk) {
  // Downstage is forward, stage left to the left: clockwise from forward.
  const double degrees = std::atan2(-walk.x, -walk.y) * 180 / std::numbers::pi;
  return fmt::format(
      "<svg viewBox=\"-10 -10 20 20\" aria-hidden=\"true\"><path transform=\"rotate({:.0f})\" fill=\"currentColor\" "
      "d=\"M0-9 6-1H2V9H-2V-1H-6Z\"/></svg>",
      degrees);
}

std::string beginning(const char* language, const std::string& title) {
  return fmt::format("<!DOCTYPE html>\n<html lang=\"{}\"><head>{}<title>{}</title>\n{}</head>", language, kHead,
                     escaped(title), kStyle);
}

}  // namespace

PartPages::PartPages(const Show& show, const Plan& plan, Stamp stamp, const PlaceWords& words)
    : show_(show), plan_(plan), stamp_(std::move(stamp)), words_(show, plan, words) {
  const Frame frame(plan.stage.grid, {}, 1, 1);
  floor_ = fmt::format("{} {} {} {} {}", centimetres(frame.low.x), centimetres(frame.low.y), centimetres(frame.high.x),
                       centimetres(frame.high.y), centimetres(plan.stage.grid.pitch_m()));
}

std::string PartPages::word(Word word) const { return escaped(text_of(words_.words().language, word)); }

std::string PartPages::neighbours(const Place& place) const {
  const Language language = words_.words().language;
  if (!place.left && !place.right && !place.ahead) {
    return "<div class=\"near\"><span class=\"n\">" + word(Word::nobody_near) + "</span></div>\n";
  }
  std::string out = "<div class=\"near\">";
  const auto add = [&](const char* side, Word told, const std::optional<PerformerIndex>& who) {
    if (!who) return;
    out += fmt::format("<span class=\"{}\">{}</span>", side,
                       escaped(say(language, told, fmt::arg("name", name_of(*who)))));
  };
  add("a", Word::ahead, place.ahead);
  add("l", Word::beside_left, place.left);
  out += "<span class=\"y\">" + word(Word::you) + "</span>";
  add("r", Word::beside_right, place.right);
  return out + "</div>\n";
}

std::string PartPages::section(const Place& place, const SheetRow& row, const std::string& cue) const {
  const Point at = plan_.stage.grid.centre(place.cell);
  std::string out = fmt::format("<section data-x=\"{}\" data-y=\"{}\">\n", centimetres(at.x), centimetres(at.y));
  if (!cue.empty()) out += "<h2>" + escaped(cue) + "</h2>\n";
  out += fmt::format("<p class=\"count\"><b>{}</b> <i>{}</i></p>\n<p class=\"cell\"><b>{}</b> {}</p>\n", row.count,
                     row.measure, escaped(row.cell), escaped(row.place));
  out += paragraph("stay", row.stay);
  if (place.way) {
    const Point next = at + place.way->walk;
    out += fmt::format("<p class=\"way\">{}<span><b>{}</b> {}</span></p>\n", arrow(place.way->walk),
                       escaped(plan_.stage.grid.name(plan_.stage.grid.nearest(next))), escaped(row.way));
  }
  out += neighbours(place);
  out += paragraph("less", row.closest) + paragraph("less", row.light);
  return out + fmt::format(
                   "<p class=\"front\">{}</p><div "
                   "class=\"maps\"><figure><div></div><figcaption>{}</figcaption></figure><figure><div></div>"
                   "<figcaption>{}</figcaption></figure></div>\n</section>\n",
                   word(Word::audience), word(Word::your_way), word(Word::whole_floor));
}

std::string PartPages::page_of(PerformerIndex who, const Part& part) const {
  const Language language = words_.words().language;
  const std::string& name = name_of(who);
  const std::vector<SheetRow> rows = words_.rows_of(part);
  const auto& group = show_.performers.at(who.at()).group;
  std::string out =
      beginning(code_of(language), name + " - " + stamp_.title) + "<body>\n<header><b>" + escaped(name) + "</b>";
  if (group) {
    out += "<i>" + escaped(say(language, Word::group, fmt::arg("name", show_.groups.at(group->at()).name))) + "</i>";
  }
  out += fmt::format("<button id=\"light\" aria-label=\"{}\">&#9680;</button></header>\n", word(Word::dark_or_light));
  if (!stamp_.valid) out += "<p><strong>REFUSED: this plan breaks its limits</strong></p>\n";
  out += "<main data-floor=\"" + floor_ + "\">\n";
  std::string cue;
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (!rows[i].cue.empty()) cue = rows[i].cue;
    out += section(part[i], rows[i], cue);
  }
  const std::string legend =
      say(language, Word::legend, fmt::arg("cm", fmt::format("{:g}", 100 * words_.words().step_m)),
          fmt::arg("beats", show_.tempo.beats_per_measure()));
  out += fmt::format(
      "</main>\n<footer>{}<br>{}   part {}</footer>\n<nav><button id=\"back\" aria-label=\"{}\">&#9664;</button><span "
      "id=\"n\" aria-live=\"polite\"></span><button id=\"on\" aria-label=\"{}\">&#9654;</button></nav>\n",
      escaped(legend), escaped(stamp_.line()), digits_of(rows), word(Word::place_before), word(Word::next_place));
  return out + kScript + "</body></html>\n";
}

std::string parts_index(const std::vector<std::pair<std::string, std::string>>& people, const Stamp& stamp,
                        Language language) {
  std::string out = beginning(code_of(language), stamp.title) + "<body>\n<header><b>" + escaped(stamp.title) +
                    "</b></header>\n<main><ul>\n";
  for (const auto& [name, file] : people) {
    out += fmt::format("<li><a href=\"{}\">{}</a></li>\n", percent_encoded(file), escaped(name));
  }
  return out + "</ul></main>\n<footer>" + escaped(stamp.line()) + "</footer>\n</body></html>\n";
}

std::string part_text(const Show& show, const Plan& plan, const Stamp& stamp, PerformerIndex who, const Part& part,
                      Language language, std::size_t most_bytes) {
  const std::string head = fmt::format("{}\n{} {}", show.performers.at(who.at()).name, stamp.title, stamp.plan);
  const auto count = [&](Instant at) { return spoken_count(show.tempo.count_at(at)); };
  std::vector<std::string> lines;
  std::size_t all = head.size();
  for (const Place& place : part) {
    const std::string from = count(place.from);
    const std::string until = count(place.until);
    lines.push_back(
        fmt::format("\n{} {}", from == until ? from : from + "-" + until, plan.stage.grid.name(place.cell)));
    all += lines.back().size();
  }
  std::string out = head;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto rest = [&](std::size_t left) { return "\n" + say(language, Word::and_more, fmt::arg("n", left)); };
    // As long as the whole does not fit, the rest must.
    if (all > most_bytes && out.size() + lines[i].size() + rest(lines.size() - i - 1).size() > most_bytes) {
      out += rest(lines.size() - i);
      break;
    }
    out += lines[i];
  }
  return out.size() > most_bytes ? std::string() : out;
}

}  // namespace footlight::app
