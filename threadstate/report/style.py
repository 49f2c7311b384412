"""The style sheet of a report: light and dark, from a phone's width on, and on paper."""

LIGHT = """
  --paper: #ffffff; --ink: #1d2733; --faint: #56616d; --grid: #e3e7ec; --rule: #c9d0d8; --ground: #f5f7f9;
  --back: #eef3f7; --fall: #b3261e; --accent: #0b5f99;
  --line-0: #0b5f99; --line-1: #b3541e; --line-2: #2f7d4f; --line-3: #7c3aed; --line-4: #56616d;
  --shade-0: #f4f1ea; --shade-1: #cfe3ee; --shade-2: #93c2dc; --shade-3: #2a78a8; --shade-4: #0a4c7b;
  --ink-0: #56616d; --ink-1: #1d2733; --ink-2: #1d2733; --ink-3: #ffffff; --ink-4: #ffffff; --hatch: #8a3b12;
"""
DARK = """
  --paper: #171b20; --ink: #e7eaee; --faint: #a3adb8; --grid: #2f353d; --rule: #454d57; --ground: #1f242b;
  --back: #1f2832; --fall: #ff8a80; --accent: #7cc0ea;
  --line-0: #6cb6f5; --line-1: #ff9b63; --line-2: #4fd1a5; --line-3: #b9a0ff; --line-4: #a3adb8;
  --shade-0: #2a2f36; --shade-1: #1b3a50; --shade-2: #1f5478; --shade-3: #69aeda; --shade-4: #b5def6;
  --ink-0: #a3adb8; --ink-1: #e7eaee; --ink-2: #ffffff; --ink-3: #171b20; --ink-4: #171b20; --hatch: #ffb380;
"""

_SHADES = "\n".join(
    f".shade-{i} {{ fill: var(--shade-{i}); }} svg .ink-{i} {{ fill: var(--ink-{i}); }} "
    f"svg .halo-{i} {{ paint-order: stroke; stroke: var(--shade-{i}); stroke-width: 4px; stroke-linejoin: round; }}"
    for i in range(5)
)
_LINES = "\n".join(
    f".line-{i} {{ stroke: var(--line-{i}); stroke-dasharray: {dashes}; }}"
    for i, dashes in enumerate(("none", "7 4", "2 3", "10 3 2 3", "1 4"))
)

STYLE = f"""
:root {{ color-scheme: light dark; {LIGHT} }}
@media (prefers-color-scheme: dark) {{ :root {{ {DARK} }} }}
* {{ box-sizing: border-box; }}
html {{ -webkit-text-size-adjust: 100%; }}
body {{ margin: 0; background: var(--paper); color: var(--ink); line-height: 1.5;
  font-family: system-ui, "Segoe UI", "DejaVu Sans", sans-serif; overflow-wrap: break-word; }}
main {{ max-width: 68rem; margin: 0 auto; padding: 1.5rem 1rem 4rem; }}
p, ul {{ max-width: 46rem; }}
h1 {{ font-size: 1.7rem; line-height: 1.25; margin: 0 0 0.25rem; }}
h2 {{ font-size: 1.3rem; line-height: 1.3; margin: 2.75rem 0 0.75rem; padding-top: 0.75rem;
  border-top: 1px solid var(--rule); }}
a {{ color: var(--accent); }}
nav ul {{ list-style: none; margin: 1rem 0 0; padding: 0; display: flex; flex-wrap: wrap;
  gap: 0.25rem 1.25rem; max-width: none; }}
.faint, figcaption, caption {{ color: var(--faint); }}
.answer {{ font-size: 1.1rem; }}
caption span {{ display: block; position: sticky; left: 0; max-width: min(46rem, calc(100vw - 2rem)); }}
.scroll {{ overflow-x: auto; margin: 1rem 0 1.5rem; }}
table {{ border-collapse: collapse; font-size: 0.92rem; font-variant-numeric: tabular-nums; }}
caption {{ text-align: left; padding-bottom: 0.4rem; font-size: 0.92rem; }}
th, td {{ padding: 0.3rem 0.8rem 0.3rem 0; text-align: left; vertical-align: top;
  border-bottom: 1px solid var(--grid); }}
thead th {{ border-bottom: 1px solid var(--rule); vertical-align: bottom; }}
tbody th {{ font-weight: 500; }}
th:not(:first-child), td {{ padding-left: 0.8rem; }}
thead th {{ max-width: 9rem; }}
.number {{ text-align: right; }}
td.sentence {{ min-width: 12rem; }}
td.number, tbody th.number {{ white-space: nowrap; }}
pre {{ background: var(--ground); border: 1px solid var(--grid); padding: 0.75rem 1rem; overflow-x: auto;
  font-size: 0.85rem; }}
.figures {{ display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 24rem), 1fr)); gap: 1.5rem 2rem;
  margin: 1.25rem 0; }}
figure {{ margin: 0; max-width: 34rem; }}
figure svg {{ display: block; width: 100%; height: auto; }}
figcaption {{ font-size: 0.88rem; margin-top: 0.3rem; }}
svg text {{ fill: var(--ink); font: 14px system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }}
svg .title {{ font-size: 15px; font-weight: 600; }}
svg .soft {{ fill: var(--faint); }} svg .middle {{ text-anchor: middle; }} svg .end {{ text-anchor: end; }}
.grid {{ stroke: var(--grid); }} .axis {{ stroke: var(--faint); }}
.back {{ fill: var(--back); }} .square {{ stroke: var(--paper); }}
.line {{ fill: none; stroke-width: 2; stroke-linejoin: round; }}
.fall {{ stroke: var(--fall); stroke-width: 0.8; stroke-dasharray: 3 3; }} svg .event {{ fill: var(--fall); }}
.hatch {{ stroke: var(--hatch); stroke-width: 1.2; }} .undecided {{ stroke: var(--rule); }}
.chosen {{ fill: none; stroke: var(--fall); stroke-width: 3; }}
{_LINES}
{_SHADES}
svg .halo-0 {{ fill: var(--ink); }}
:focus-visible {{ outline: 2px solid var(--accent); outline-offset: 2px; }}
@media print {{
  @page {{ size: A4; margin: 16mm 15mm; }}
  :root {{ color-scheme: light; {LIGHT} --faint: #3a434d; --ink: #000000; }}
  body {{ font-size: 10pt; line-height: 1.4; }}
  main {{ max-width: none; padding: 0; }}
  nav {{ display: none; }}
  h1 {{ font-size: 17pt; }} h2 {{ font-size: 13pt; margin-top: 1.5rem; }}
  h2, caption, h2 + p, p:has(+ pre) {{ break-after: avoid; }}
  p, li {{ orphans: 3; widows: 3; }}
  figure, tr, .short {{ break-inside: avoid; }}
  thead {{ display: table-header-group; }}
  .scroll, pre {{ overflow: visible; }}
  pre {{ white-space: pre-wrap; break-inside: avoid; }}
  .figures {{ display: block; }}
  figure {{ display: inline-block; width: 48%; margin: 0 1% 1rem 0; vertical-align: top; }}
  table {{ font-size: 8.5pt; max-width: 100%; }}
  th, td {{ padding: 0.12rem 0.4rem 0.12rem 0; }} th:not(:first-child), td {{ padding-left: 0.4rem; }}
  figcaption, caption {{ font-size: 8.5pt; }} .answer {{ font-size: 11pt; }}
  svg {{ print-color-adjust: exact; }}
}}
"""
