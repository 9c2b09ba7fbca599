-- The look of a report. Colours of the series are by Okabe and Ito ("Color Universal Design", 2008),
-- darkened for light pages and lightened for dark ones, so that each stands out from its ground.
return [[
:root {
  color-scheme: light dark;
  --ground: #fbfaf8; --panel: #fff; --ink: #1d1b19; --quiet: #6a635c; --rule: #e6e1da; --faint: #f4f1ec;
  --accent: #b8430b; --bad: #b3261e; --chosen: #fff1dd;
  --c1: #0068a8; --c2: #c9510c; --c3: #00805c; --c4: #a8478a; --c5: #8a6a00; --c6: #2b8cc4; --c7: #7a2e2e; --c8: #8b857e;
}
@media (prefers-color-scheme: dark) { :root {
  --ground: #141210; --panel: #1c1917; --ink: #ece7e1; --quiet: #a8a096; --rule: #37312b; --faint: #24201d;
  --accent: #fb923c; --bad: #ff8a80; --chosen: #3a2a17;
  --c1: #5db6ee; --c2: #ff8f52; --c3: #35cfa2; --c4: #e793cd; --c5: #e3bc42; --c6: #a5d8f7; --c7: #e39a9a; --c8: #8f887f;
} }
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body { margin: 0; background: var(--ground); color: var(--ink); font: 16px/1.5 system-ui, "Segoe UI", Inter, "Helvetica Neue", sans-serif;
  font-variant-numeric: tabular-nums; overflow-wrap: anywhere; }
main { max-width: 1180px; margin: 0 auto; padding: 40px 24px 32px; }
h1 { font-size: clamp(26px, 4.2vw, 38px); line-height: 1.15; letter-spacing: -0.02em; margin: 4px 0 14px; text-wrap: balance; }
h2 { font-size: 22px; letter-spacing: -0.01em; margin: 56px 0 6px; padding-top: 18px; border-top: 1px solid var(--rule); }
h3 { font-size: 17px; margin: 30px 0 2px; }
h4 { font-size: 13px; margin: 0 0 4px; font-weight: 600; }
p { margin: 0 0 12px; max-width: 76ch; }
.eyebrow { color: var(--accent); font-size: 13px; font-weight: 600; letter-spacing: 0.04em; margin: 0; }
.summary { font-size: 18px; line-height: 1.5; }
.note { padding-left: 14px; border-left: 3px solid var(--rule); color: var(--quiet); }
.lead, .quiet, small, figcaption { color: var(--quiet); }
.n { text-align: right; white-space: nowrap; }
.facts { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 250px), 1fr)); gap: 12px 28px; margin: 24px 0 0;
  padding: 18px 20px; background: var(--panel); border: 1px solid var(--rule); border-radius: 10px; font-size: 14px; }
dt { color: var(--quiet); font-size: 12px; }
dd { margin: 0; }
.failures { border-left: 4px solid var(--bad); padding-left: 18px; margin-top: 32px; }
.failures h2 { border: 0; margin: 0; padding: 0; color: var(--bad); }
.failures ul { padding-left: 18px; }
.failures li { margin: 8px 0; white-space: pre-line; }

figure { margin: 0; }
summary { font-weight: 600; cursor: pointer; }
details { margin: 14px 0; }
details[open] summary { font-size: 17px; margin-bottom: 2px; }
.panels { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 330px), 1fr)); gap: 14px; }
.panels figure, .pair > figure { background: var(--panel); border: 1px solid var(--rule); border-radius: 10px; padding: 12px 12px 8px; }
figcaption { font-size: 12.5px; }
.plot { display: block; width: 100%; max-width: 470px; height: auto; overflow: visible; }
.plot.wide { max-width: 760px; }
.plot.narrow { display: none; }
.plot text { font-size: 11px; fill: var(--quiet); }
.plot .label { font-weight: 600; fill: var(--ink); }
.plot .name { font-size: 11px; }
.plot .strong { font-weight: 700; fill: var(--accent); }
.grid { stroke: var(--rule); stroke-width: 1; }
.axis { stroke: var(--quiet); stroke-width: 1; }
.line { fill: none; stroke-width: 2; stroke-linejoin: round; }
.whisker { stroke-width: 1.2; opacity: 0.75; }
.leader { stroke-width: 1; opacity: 0.5; }
.mark { stroke: var(--panel); stroke-width: 1; }
.front { fill: none; stroke: var(--quiet); stroke-width: 1.5; stroke-dasharray: 4 3; }
.ring { fill: none; stroke: var(--accent); stroke-width: 2; }
.pair { display: grid; grid-template-columns: minmax(0, 1.7fr) minmax(0, 1fr); gap: 18px; align-items: start; }
.legend { display: flex; flex-wrap: wrap; gap: 2px 12px; align-items: baseline; font-size: 13px; }
.key { list-style: none; display: flex; flex-wrap: wrap; gap: 4px 16px; margin: 0 0 8px; padding: 0; font-size: 13px; }
.key li { display: flex; align-items: center; gap: 6px; }
.dot { width: 12px; height: 12px; flex: none; }
.swatch { width: 11px; height: 11px; border-radius: 2px; flex: none; }

.bars { list-style: none; margin: 0; padding: 0; font-size: 13px; }
.bars li { display: grid; grid-template-columns: minmax(90px, 210px) 1fr 70px; gap: 0 12px; align-items: center; padding: 2px 0; }
.bars .what { text-align: right; }
.stack { display: block; width: 100%; height: 15px; }

.scroll { overflow-x: auto; max-width: 100%; border: 1px solid var(--rule); border-radius: 10px; background: var(--panel); }
.scroll.narrow { max-width: 560px; margin-top: 14px; }
.scroll:focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; }
table { border-collapse: collapse; width: 100%; font-size: 13.5px; overflow-wrap: normal; }
th, td { padding: 5px 11px; text-align: left; vertical-align: top; border-bottom: 1px solid var(--rule); }
th.n, td.n { text-align: right; }
thead th, thead th.n { font-weight: 600; font-size: 12px; color: var(--quiet); vertical-align: bottom; white-space: normal; min-width: 58px;
  overflow-wrap: break-word; }
tbody th { font-weight: 400; color: var(--quiet); }
tbody tr:last-child > * { border-bottom: 0; }
.rows tr > :first-child { position: sticky; left: 0; background: var(--panel); min-width: 38px; width: 1%; }
td small { display: block; font-size: 11px; line-height: 1.2; }
td.state { color: var(--bad); white-space: pre-line; min-width: 300px; }
.published { background: var(--faint); }
tr.chosen > *, .rows tr.chosen > :first-child { background: var(--chosen); }
tr.before > * { font-style: italic; }

.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 200px), 1fr)); gap: 16px; margin-top: 12px; }
.pictures img { display: block; width: 100%; height: auto; border-radius: 8px; background: var(--faint); }
.pictures figcaption { display: flex; justify-content: space-between; gap: 10px; padding-top: 4px; color: var(--ink); }
footer { margin-top: 56px; padding-top: 14px; border-top: 1px solid var(--rule); color: var(--quiet); font-size: 13px; }
.f1 { fill: var(--c1); } .f2 { fill: var(--c2); } .f3 { fill: var(--c3); } .f4 { fill: var(--c4); }
.f5 { fill: var(--c5); } .f6 { fill: var(--c6); } .f7 { fill: var(--c7); } .f8 { fill: var(--c8); }
.s1 { stroke: var(--c1); } .s2 { stroke: var(--c2); } .s3 { stroke: var(--c3); } .s4 { stroke: var(--c4); }
.s5 { stroke: var(--c5); } .s6 { stroke: var(--c6); } .s7 { stroke: var(--c7); } .s8 { stroke: var(--c8); }
.b1 { background: var(--c1); } .b2 { background: var(--c2); } .b3 { background: var(--c3); } .b4 { background: var(--c4); }
.b5 { background: var(--c5); } .b6 { background: var(--c6); } .b7 { background: var(--c7); } .b8 { background: var(--c8); }
.plot .label.f1 { fill: var(--c1); } .plot .label.f2 { fill: var(--c2); } .plot .label.f3 { fill: var(--c3); } .plot .label.f4 { fill: var(--c4); }
.plot .label.f5 { fill: var(--c5); } .plot .label.f6 { fill: var(--c6); } .plot .label.f7 { fill: var(--c7); } .plot .label.f8 { fill: var(--c8); }

@media screen and (max-width: 760px) {
  .plot.wide { display: none; }
  .plot.narrow { display: block; }
  .facts { grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 10px 16px; padding: 14px; }
  main { padding: 24px 14px; }
  .summary { font-size: 16px; }
  .pair { grid-template-columns: minmax(0, 1fr); }
  .bars li { grid-template-columns: 1fr auto; padding: 5px 0; }
  .bars .what { text-align: left; }
  .bars .stack { grid-row: 2; grid-column: 1 / 3; }
  .pictures { grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 10px; font-size: 13px; }
}
@media print {
  :root { color-scheme: light;
    --ground: #fff; --panel: #fff; --ink: #000; --quiet: #555; --rule: #ccc; --faint: #f2f2f2; --accent: #b8430b; --bad: #b3261e; --chosen: #ffe9c9;
    --c1: #0068a8; --c2: #c9510c; --c3: #00805c; --c4: #a8478a; --c5: #8a6a00; --c6: #2b8cc4; --c7: #7a2e2e; --c8: #8b857e; }
  @page { size: A4; margin: 14mm; }
  @page rows { size: A4 landscape; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  body { font-size: 10pt; }
  main { max-width: none; padding: 0; }
  h2 { margin-top: 22px; }
  h2, h3, h4, summary, .lead, .key { break-after: avoid; }
  figure, .bars li, tr, .facts, .lead { break-inside: avoid; }
  .lead { max-width: none; }
  .pair { grid-template-columns: minmax(0, 1fr); }
  .summary { font-size: 11.5pt; }
  details::details-content { content-visibility: visible; block-size: auto; }
  summary { list-style: none; }
  .panels { grid-template-columns: repeat(2, 1fr); gap: 8px; }
  .pictures { grid-template-columns: repeat(4, 1fr); font-size: 8pt; }
  #rows { page: rows; }
  .scroll { overflow: visible; border: 0; }
  table { font-size: 7.5pt; }
  thead { display: table-header-group; }
  th, td { padding: 2px 5px; }
  thead th, thead th.n { font-size: 7pt; min-width: 0; }
  td small { font-size: 6pt; }
  .rows tr > :first-child { position: static; min-width: 0; }
  td.state { min-width: 0; }
}
]]
