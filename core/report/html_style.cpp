#include "report/html_style.h"

#include <fmt/format.h>

#include "report/palette.h"

namespace cloth {
namespace {

constexpr const char* light = R"(:root {
  color-scheme: light dark;
  --surface: #ffffff; --ink: #1f2328; --muted: #596069; --line: #d9dde2; --soft: #f4f5f7; --accent: #005a8c;
  --good: #dcecf8; --warn: #fbecc0; --bad: #fadbc8;
}
)";

constexpr const char* dark = R"(  :root {
    --surface: #14171c; --ink: #e6e9ed; --muted: #a2abb6; --line: #343b45; --soft: #1c2128; --accent: #7cc4f5;
    --good: #16364f; --warn: #4a3c10; --bad: #552a12;
  }
)";

constexpr const char* rules = R"(* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body {
  margin: 0; background: var(--surface); color: var(--ink);
  font: 16px/1.6 -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, "Liberation Sans", sans-serif;
}
main { max-width: 1024px; margin: 0 auto; padding: 40px 32px 80px; }
p, ul, .notice, h1, h2, h3, nav, summary { max-width: 46rem; }
h1 { font-size: 2rem; line-height: 1.2; margin: 0 0 .5rem; letter-spacing: -.01em; }
h2 { font-size: 1.4rem; line-height: 1.3; margin: 3rem 0 .75rem; padding-top: .9rem; border-top: 1px solid var(--line); max-width: none; }
h3 { font-size: 1.1rem; line-height: 1.35; margin: 2rem 0 .5rem; }
p, ul { margin: 0 0 1rem; }
ul { padding-left: 1.4rem; }
li { margin: .25rem 0; }
.lead { font-size: 1.1rem; color: var(--muted); }
sup { font-size: .75em; line-height: 0; }
a { color: var(--accent); text-underline-offset: .15em; }
nav { margin: 1.75rem 0 0; padding: .9rem 1.2rem; background: var(--soft); border-radius: 8px; font-size: .94rem; }
nav ol { list-style: none; margin: 0; padding: 0; }
nav .level-3 { padding-left: 1.2rem; }
code, pre { font-family: ui-monospace, "SF Mono", Consolas, "Liberation Mono", "DejaVu Sans Mono", monospace; font-size: .88em; }
code { background: var(--soft); padding: .1em .32em; border-radius: 4px; overflow-wrap: anywhere; box-decoration-break: clone; -webkit-box-decoration-break: clone; }
pre { background: var(--soft); padding: .8rem 1rem; border-radius: 8px; overflow-x: auto; line-height: 1.45; margin: 0 0 1rem; }
pre code { background: none; padding: 0; overflow-wrap: normal; }
.notice { margin: 0 0 1rem; padding: .7rem 1rem; border-left: 4px solid var(--muted); background: var(--soft); border-radius: 0 8px 8px 0; }
.scroll { overflow-x: auto; margin: 0 0 1.5rem; }
table { border-collapse: collapse; font-size: .9rem; line-height: 1.4; font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--muted); padding: 0 0 .5rem; }
th, td { padding: .38rem .8rem; text-align: left; vertical-align: top; border-bottom: 1px solid var(--line); }
thead th { border-bottom: 2px solid var(--muted); vertical-align: bottom; }
.right { text-align: right; white-space: nowrap; }
.centre { text-align: center; }
.good { background: var(--good); } .warn { background: var(--warn); } .bad { background: var(--bad); }
.notice.good, .notice.warn, .notice.bad { border-left-color: var(--ink); }
.facts th { font-weight: 600; white-space: nowrap; padding-left: 0; color: var(--muted); }
.facts td { overflow-wrap: anywhere; }
figure { margin: 1.5rem 0 2rem; }
figure svg, figure img { display: block; max-width: 100%; height: auto; }
figure .drawing { overflow-x: auto; margin: 0 -16px; }
figcaption { max-width: 46rem; margin-top: .6rem; font-size: .92rem; color: var(--muted); }
figcaption b { color: var(--ink); }
.command { display: block; margin-top: .3rem; }
details { margin: 0 0 1rem; border: 1px solid var(--line); border-radius: 8px; padding: .5rem 1rem; }
summary { cursor: pointer; font-weight: 600; }
details[open] > summary { margin-bottom: .6rem; }
@media (max-width: 640px) { main { padding: 20px 16px 48px; } figure svg { min-width: 640px; } }
@media print {
  body { font-size: 10.5pt; }
  main { max-width: none; padding: 0; }
  figure, tr, .notice { break-inside: avoid; }
  h2, h3 { break-after: avoid; }
  .scroll, pre, figure .drawing { overflow: visible; }
  figure .drawing { margin: 0; }
  pre { white-space: pre-wrap; }
  .good, .warn, .bad, svg * { -webkit-print-color-adjust: exact; print-color-adjust: exact; }
}
)";

}  // namespace

std::string html_style() {
  std::string drawings;
  for (const PageColour& colour : all_colours())
    drawings +=
        fmt::format("  .f-{0} {{ fill: {1}; }} .s-{0} {{ stroke: {1}; }}\n", colour.name, colour.dark);
  return std::string(light) + "@media screen and (prefers-color-scheme: dark) {\n" + dark + drawings + "}\n" +
         rules;
}

}  // namespace cloth
