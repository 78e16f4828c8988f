"""The sections of the page of speed against error: what is swept, beside the sentence why its default stands there."""
import math

from speed_plots import pareto, stacked


def number(value, digits=3):
    """Rounded; powers of ten for what is smaller than a thousandth only."""
    if value is None:
        return ""
    if not math.isfinite(value):
        return "not found"
    if value == 0 or abs(value) < 1e-3:
        return f"{value:.{digits}g}"
    decimals = digits - 1 - math.floor(math.log10(abs(value)))
    return f"{round(value, decimals):,.{max(0, decimals)}f}"


def exactly(value):
    return "the last bit" if value == 0 else number(abs(value), 1)


def milliseconds(measured):
    low, high = measured.range
    return f"{number(measured.ms)} ({number(low)} to {number(high)})"


def table(head, rows, marked=()):
    """`marked`: numbers of the rows that are the default's."""
    text = "<div class=wide><table><tr>" + "".join(f"<th>{cell}" for cell in head) + "</tr>\n"
    for place, row in enumerate(rows):
        cells = "".join(f"<td{' class=n' if i else ''}>{cell}</td>" for i, cell in enumerate(row))
        text += f"<tr{' class=default' if place in marked else ''}>{cells}</tr>\n"
    return text + "</table></div>\n"


def figure(svg, caption):
    return f"<figure>{svg}<figcaption>{caption}</figcaption></figure>\n"


def spread_of(measured):
    low, high = measured.range
    return low, measured.ms, high


def on_the_front(points, default):
    """A sentence: does any other setting do better in both? points: {label: (Measured, error)}."""
    own, own_error = points[default]
    better = [label for label, (one, error) in points.items() if one.range[1] < own.range[0] and error < own_error]
    return f" Faster and nearer than it: {', '.join(better)}." if better else " No other is both faster and nearer."


def surface_sweep(results, prefix, default, caption, why):
    sweep = results.sweep(prefix)
    if not sweep:
        return ""
    finest = sweep[-1][0]
    labels = {argument: f"{argument:,}" for argument, _ in sweep}
    truth = [(labels[a], spread_of(m), m.value("truth_p95_mm")) for a, m in sweep]
    itself = [(labels[a], spread_of(m), m.value("finest_p95_mm")) for a, m in sweep if a != finest]
    svg = pareto({"to the true skin": truth, f"to the finest, {finest:,}": itself}, "ms (processor)",
                 "distance of 95 % of the mesh, mm", labels[default])
    rows = [[labels[a], m.n, milliseconds(m), number(m.value("peak_mib")), number(m.value("truth_median_mm")),
             number(m.value("truth_p95_mm")), number(m.value("truth_p99_mm")), number(m.value("finest_p95_mm")), number(m.value("girth_mm")),
             number(m.value("height_mm"))] for a, m in sweep]
    points = {labels[a]: (m, m.value("truth_p95_mm")) for a, m in sweep}
    by_argument = dict(sweep)
    return (f"<p>{why(by_argument)}{on_the_front(points, labels[default])}</p>\n" + figure(svg, caption) +
            table(["", "n", "ms", "MiB", "truth 50 %, mm", "truth 95 %, mm", "99 %, mm", "finest 95 %, mm", "girth, mm", "height, mm"],
                  rows, [[a for a, _ in sweep].index(default)]))


def of_each(at, values, counter, unit="mm"):
    """What a counter is at each value, in words: 1.2 mm at 8, 1.1 mm at 9."""
    return ", ".join(f"{number(at[value].value(counter))} {unit} at {value:,}" for value in values)


def depth_section(results):
    def why(at):
        return (f"<b>Default 9.</b> 99 % of the skin that the sensors saw is within "
                f"{of_each(at, (7, 8, 9, 10), 'truth_p99_mm')}. This body is "
                f"smooth; 9 was chosen on bodies with fingers, ears and folds, has cells of 3.6 mm, and costs "
                f"{number(at[9].ms / at[8].ms, 3)} times the "
                f"time of 8. Depth 10 takes {number(at[10].ms / at[9].ms, 2)} times as long and "
                f"{number(at[10].value('peak_mib') / at[9].value('peak_mib'), 2)} times the memory: cells deeper than "
                f"the points are dense.")
    return "<h2>Poisson depth</h2>\n" + surface_sweep(
        results, "by_depth", 9, "180,000 points, 62,000 body triangles. The default is ringed.", why)


def points_section(results):
    def why(at):
        return (f"<b>The booth decides;</b> 180,000 is the scan that the design is for. 99 % is within "
                f"{of_each(at, (20000, 40000, 180000, 720000), 'truth_p99_mm')}; times grow from "
                f"{number(at[20000].ms)} to "
                f"{number(at[720000].ms)} ms only, since above 400,000 close points are merged first.")
    return "<h2>Points of the scan</h2>\n" + surface_sweep(
        results, "by_points", 180000, "Depth 9, 62,000 body triangles, 0.8 mm noise.", why)


def triangles_section(results):
    def why(at):
        return (f"<b>Default 62,000,</b> the body of the papers. 99 % is within "
                f"{of_each(at, (8000, 31000, 62000, 125000), 'truth_p99_mm')}. The "
                f"surface is made fine in any case and then reduced, so fewer triangles save little here; more cost in "
                f"each stage after this "
                f"one, on topics and on the screen.")
    return "<h2>Body triangles</h2>\n" + surface_sweep(
        results, "by_triangles", 62000, "180,000 points, depth 9.", why)


def control_section(results):
    series, rows, at, finest = {}, [], {}, 7680
    for way in ("cold", "warm"):
        sweep = results.sweep(f"{way}/equilibrium")
        series[way] = []
        for triangles, m in sweep:
            at[way, triangles] = m
            error = at["cold", triangles].value("to_finest_rms_mm")
            if triangles != finest:
                series[way].append((f"{triangles:,}", spread_of(m), error))
            rows.append([f"{way}, {triangles:,}", m.n, milliseconds(m), number(m.value("peak_mib")), m.label,
                         number(m.value("steps")), number(m.value("line_error")), number(m.value("volume_error")),
                         number(error), number(at["cold", triangles].value("to_finest_max_mm"))])
    if not at:
        return ""
    svg = pareto(series, "ms of a solution (processor)", f"body against {finest:,} triangles, mm rms", "120")
    coarse, default, fine = (at["cold", t] for t in (60, 120, 480))
    points = {str(t): (at["cold", t], at["cold", t].value("to_finest_rms_mm")) for t in (60, 120, 480, 1920)}
    why = (f"<b>Default 120,</b> the control mesh of the papers. The worn body is "
           f"{number(default.value('to_finest_rms_mm'), 2)} mm rms "
           f"from that of {finest:,} triangles, with 60 triangles {number(coarse.value('to_finest_rms_mm'), 2)}, with "
           f"480 "
           f"{number(fine.value('to_finest_rms_mm'), 2)}; but 480 takes {number(fine.ms / default.ms, 2)} times as "
           f"long, and a clerk's slider "
           f"is to answer within 5 ms (warm here: {number(at['warm', 120].ms, 2)} against "
           f"{number(at['warm', 480].ms, 2)} ms). Line and "
           f"volume are exact at any number.")
    return ("<h2>Control triangles</h2>\n" + f"<p>{why}{on_the_front(points, '120')}</p>\n" +
            figure(svg, "B1 at 0.90 on the virtual body. cold: from rest; warm: from the balance at 0.91.") +
            table(["", "n", "ms", "MiB", "status", "steps", "line", "volume", "to finest, mm rms", "largest"], rows,
                  [place for place, row in enumerate(rows) if row[0].endswith(", 120")]))


def solver_section(results):
    series, rows = {}, []
    for solver in ("equilibrium", "adaptive", "relaxation"):
        sweep = results.sweep(f"stopped/{solver}")
        if not sweep:
            return ""
        reached = {m.value("steps"): (most, m) for most, m in reversed(sweep)}  # what had ended before its cap once
        series[solver] = [(str(most), spread_of(m), m.value("from_balance_mm"))
                          for most, m in sorted(reached.values(), key=lambda cap: cap[0])]
        rows += [[f"{solver}, {most}", m.n, milliseconds(m), m.label, number(m.value("steps")),
                  number(m.value("line_error")), number(m.value("volume_error")), number(m.value("residual")),
                  number(m.value("from_balance_mm"))] for most, m in sweep]
    svg = pareto(series, "ms (processor)", "farthest node from the balance, mm", floor=1e-6)
    ours, theirs = results["stopped/equilibrium/1000"], results["stopped/relaxation/1000"]
    adaptive = results["stopped/adaptive/1000"]
    why = (f"<b>Default equilibrium, until it has converged</b> ({number(ours.value('steps'))} steps, "
           f"{number(ours.ms, 2)} ms): the line is "
           f"exact to {exactly(ours.value('line_error'))} and the volume to {exactly(ours.value('volume_error'))}. "
           f"With 1,000 cycles "
           f"the line of relaxation is still {number(100 * theirs.value('line_error'), 2)} % too long "
           f"({number(theirs.ms, 2)} ms), that of adaptive "
           f"{number(100 * adaptive.value('line_error'), 2)} % ({number(adaptive.ms, 2)} ms). A step less than it "
           f"takes leaves the balance by more than it "
           f"saves.")
    return ("<h2>Solver and iterations</h2>\n" + f"<p>{why}</p>\n" +
            figure(svg, "B1 at 0.90, 120 control triangles; numbers are the iterations after which it was stopped. "
                        "Drawn at "
                        "a millionth of a millimetre: nearer than that.") +
            "<details><summary>Table</summary>" +
            table(["", "n", "ms", "status", "iterations", "line", "volume", "residual", "mm from balance"], rows) + "</details>\n")


def tffd_section(results):
    series, rows, at = {}, [], {}
    for precision in ("reference", "fast"):
        series[f"{ {'reference': 'double', 'fast': 'float'}[precision] }"] = points = []
        for vertices in (31000, 250000):
            for millionths, m in results.sweep(f"on_chest_skin/{precision}/{vertices}"):
                label = "0" if millionths == 0 else f"{1e-6 * millionths:g}"
                at[precision, vertices, millionths] = m
                rows.append([f"{precision}, {vertices:,} vertices, {label}", m.n, milliseconds(m), number(m.value("entries_a_row")),
                             number(m.value("mm_off"), 2), number(m.value("truncation_mm"), 2)])
                if vertices == 31000:
                    points.append((label, spread_of(m), m.value("mm_off")))
    if not rows:
        return ""
    for name in ("on_body/reference/31000", "on_body/fast/31000", "on_body/paper/31000", "dense/31000"):
        m = results[name]
        rows.append([name, m.n, milliseconds(m), number(m.value("entries_a_row")), number(m.value("mm_off"), 2), ""])
    exact, cut = at["reference", 31000, 0], at["reference", 31000, 1000]
    single, body = at["fast", 31000, 0], results["on_body/reference/31000"]
    svg = pareto(series, "ms for 31,000 carried vertices (processor)", "farthest vertex from the exact one, mm", "0", floor=1e-6)
    why = (f"<b>Default double, no truncation.</b> A change of garment moves some {number(body.value('carried'), 2)} "
           f"vertices of a body of 31,000: "
           f"{number(body.ms, 2)} ms. Where all 31,000 are carried, float saves "
           f"{number(100 * (1 - single.ms / exact.ms), 2)} % and costs "
           f"{number(single.value('mm_off'), 1)} mm, a truncation of 0.001 {number(100 * (1 - cut.ms / exact.ms), 2)} "
           f"% and "
           f"{number(cut.value('mm_off'), 1)} mm: beside {number(results['warm/equilibrium/120'].ms, 2)} ms of "
           f"solving, nothing that exactness "
           f"should be given for.")
    return ("<h2>t-FFD: truncation and precision</h2>\n" + f"<p>{why}</p>\n" +
            figure(svg, "Numbers: the share of a vertex's largest weight below which others are dropped. Exact ones "
                        "are drawn at "
                        "a millionth of a millimetre.") +
            "<details><summary>Table</summary>" +
            table(["", "n", "ms", "entries a row", "mm off", "bound, mm"], rows) + "</details>\n")


def scene_section(results):
    stages = ("reconstruction", "landmarks", "control_mesh", "tensegric", "tffd")
    rows, bars = [], []
    whole = results["scan_to_view/both_shown"]
    if whole is None:
        return ""
    for scene, words in (("measure", "measured only"), ("bust", "bust"), ("hips", "hips"), ("both", "bust and hips")):
        for ending, listeners in (("", ""), ("_shown", ", with listeners")):
            m = results[f"scan_to_view/{scene}{ending}"]
            parts = {stage: m.value(stage, 0) for stage in stages}
            parts["messages for people"] = max(0, m.wall_ms - sum(parts.values())) if ending else 0
            parts = {part: taken * m.ms / m.wall_ms for part, taken in parts.items()}  # of the processor
            bars.append((words + listeners, parts))
            rows.append([words + listeners, m.n, milliseconds(m), number(m.wall_ms), number(m.value("peak_mib")),
                         f"{100 * (1 - m.ms / whole.ms):.0f} %", *(number(parts[stage]) for stage in stages),
                         number(parts["messages for people"])])
    svg = stacked(bars, (*stages, "messages for people"), "ms of the processor from scan to first view, 180,000 points")
    changes = results.sweep("garment_change")
    change_rows = [[f"{triangles:,}", m.n, milliseconds(m), m.label, number(m.value("line_error"), 2),
                    number(m.value("control_volume_error"), 2)] for triangles, m in changes]
    return ("<h2>Only what the scene needs</h2>\n<p>A scene solves and binds the regions that its garment names; "
            "pictures, markers and "
            "meshes for people are made only while someone listens. Saved: against bust and hips with listeners to "
            "every topic of every "
            "stage. <b>Default: no listener, no message,</b> and the garment decides what is solved.</p>\n" +
            figure(svg, "Medians. One process, without a master; stages as their share of it.") +
            table(["", "n", "ms", "wall clock", "MiB", "saved", *stages, "messages"], rows) +
            "<p>A garment changed by 0.01 on a loaded body, by the number of control triangles:</p>\n" +
            table(["", "n", "ms", "status", "line", "volume"], change_rows))


def guard_section(stages):
    def times(value):
        return "" if value is None else f"{value:.2f}"  # None: the stage is not in the baseline, or only there

    rows = [[s["stage"], number(s["ms"]), number(s["kernels"]), number(s["baseline_kernels"]), f"{times(s['time_ratio'])} {s['time']}",
             times(s["spread"]), number(s["mib"]), number(s["baseline_mib"]), f"{times(s['memory_ratio'])} {s['memory']}"] for s in stages]
    words = [s[what] for s in stages for what in ("time", "memory")]
    verdict = "fails" if "FAILS" in words else "warns" if "warning" in words else "holds"
    return (f"<h2>Guard: {verdict}</h2>\n<p>Each stage in times of a calibration kernel that runs in the same process "
            f"right before it, and by "
            f"how much the process grows, against <code>tests/benchmarks/speed_baseline.yaml</code>; medians of "
            f"{stages[0]['rounds']}. "
            f"1.3 times as much is a warning, twice a failure, and so is a stage that only one of both has.</p>\n" +
            table(["stage", "ms", "kernels", "baseline", "time", "spread", "MiB", "baseline", "memory"], rows))


def yardstick_section(results):
    rows = []
    for name, words in (("by_depth/9", "ours: outliers, normals, Poisson, repair, fitting"), ("pcl_poisson/8", "PCL Poisson, depth 8"),
                        ("pcl_poisson/9", "PCL Poisson, depth 9"), ("cgal_poisson", "CGAL Poisson"),
                        ("cgal_advancing_front", "CGAL advancing front")):
        m = results[name]
        if m:
            rows.append([words, m.n, milliseconds(m), number(m.value("peak_mib")), number(m.value("truth_median_mm")),
                         number(m.value("truth_p95_mm")), number(m.value("triangles")), "yes" if m.value("closed") else "no"])
    for name, words in (("arap/body", "CGAL ARAP, whole body"), ("arap/region", "CGAL ARAP, the region alone"),
                        ("cold_to_body", "ours, cold, to the body"), ("warm_to_body", "ours, warm, to the body")):
        m = results[name]
        if m:
            rows.append([words, m.n, milliseconds(m), "", "", "", "", ""])
    return ("<h2>Yardsticks</h2>\n<p>Other reconstructions get our points without strays and our normals for nothing, "
            "and their result is "
            "taken as it comes. ARAP: ten iterations, without its factorisation, the line's nodes put where ours "
            "are.</p>\n" +
            table(["", "n", "ms", "MiB", "truth 50 %, mm", "truth 95 %, mm", "triangles", "closed"], rows))


def headlines(results):
    rows = []
    for over, under, words in (
            ("arap/body", "warm_to_body", "ARAP of the whole body (CGAL) / a change of garment, to the body"),
            ("arap/body", "cold_to_body", "ARAP of the whole body (CGAL) / a garment put on, to the body"),
            ("arap/region", "warm_to_body", "ARAP of the region alone (CGAL) / a change of garment"),
            ("arap/region", "cold_to_body", "ARAP of the region alone (CGAL) / a garment put on"),
            ("dense/31000", "on_chest_skin/reference/31000/0", "t-FFD with every weight / with those in reach"),
            ("pcl_poisson/9", "by_depth/9", "PCL Poisson alone, depth 9 / our whole reconstruction"),
            ("cgal_poisson", "by_depth/9", "CGAL Poisson alone / our whole reconstruction"),
            ("cgal_advancing_front", "by_depth/9", "CGAL advancing front alone / our whole reconstruction"),
            ("cold/relaxation/120", "cold/equilibrium/120", "relaxation (P1) / equilibrium, cold"),
            ("cold/adaptive/120", "cold/equilibrium/120", "adaptive (P2) / equilibrium, cold")):
        ratio = results.ratio(over, under)
        if ratio:
            error = results[over].value("line_error")
            if error is not None:
                words += f", with lines {number(100 * error, 2)} % too long"
            rows.append([words, f"<b>{number(ratio[0], 2)}</b>", f"{number(ratio[1], 2)} to {number(ratio[2], 2)}",
                         f"{results[over].n}, {results[under].n}"])
    return "<h2>Ratios</h2>\n" + table(["time of / time of", "ratio", "from all runs", "n"], rows)
