//! Figures, pictures, tables and the page: what holds for every trace.

mod fake;
mod view;

use flexure::prove::question::{Question, prove};
use flexure::prove::summary::ProofSummary;
use flexure::report::AssumedNumber;
use flexure::report::RunsReport;
use flexure::report::decimate::{Thinned, bucket_size, decimate, envelope};
use flexure::report::{
    CertificateReport, FigureOptions, JointMarks, Practical, RunReport, Sketch, Ultimate, Verdict, WIDTH,
    certificate_table, comparison, four_panel, html, proof_table, run_figure, summary_table,
};
use flexure::scenario::load_scenario;
use flexure::simulate::{Summary, Trace};
use roxmltree::Document;

fn figure(trace: &Trace) -> String {
    let options = FigureOptions {
        title: "tanh, 1 kHz".to_owned(),
        subtitle: "quanser-2dof".to_owned(),
        joints: vec![JointMarks::named("shoulder")],
        ..FigureOptions::default()
    };
    four_panel(&Sketch::of(trace), &options).svg()
}

/// Well-formed, and every number in every attribute finite.
fn check(svg: &str) {
    let document = Document::parse(svg).expect("well-formed XML");
    for attribute in document.descendants().flat_map(|node| node.attributes()) {
        let value = attribute.value().to_ascii_lowercase();
        assert!(!value.contains("nan") && !value.contains("inf"), "{}=\"{value}\"", attribute.name());
    }
    assert!(svg.len() < 300_000, "{} bytes", svg.len());
}

fn texts(svg: &str) -> Vec<String> {
    let document = Document::parse(svg).expect("well-formed XML");
    let text = |node: roxmltree::Node| node.text().unwrap_or_default().to_owned();
    document.descendants().filter(|node| node.has_tag_name("text")).map(text).collect()
}

/// How many curves a figure holds: its only paths with relative steps.
fn curves(svg: &str) -> usize {
    let document = Document::parse(svg).expect("well-formed XML");
    document.descendants().filter(|node| node.attribute("d").is_some_and(|d| d.contains('l'))).count()
}

#[test]
fn every_joint_count_draws_every_signal_with_each_label_once() {
    for joints in 1..=8 {
        let svg = figure(&fake::trace(joints, 10_000, 6.0));
        check(&svg);
        // 8 signals a joint, torques twice: the start-up frame holds them too.
        assert_eq!(curves(&svg), 9 * joints);
        let texts = texts(&svg);
        let count = |label: &str| texts.iter().filter(|text| *text == label).count();
        for label in ["link side", "motor side", "reference"] {
            assert_eq!(count(label), 1, "{label}");
        }
        // By its name where there is one.
        assert_eq!((count("shoulder"), count("joint 1")), (1, 0));
        for joint in 2..=8 {
            assert_eq!(count(&format!("joint {joint}")), usize::from(joint <= joints));
        }
    }
}

#[test]
fn a_clipped_peak_is_stated() {
    let svg = figure(&fake::trace(2, 10_000, 6.0));
    assert!(texts(&svg).iter().any(|text| text.contains("peak 5697 N m at 0 s")), "{:?}", texts(&svg));
}

#[test]
fn noise_in_every_signal_stays_small() {
    let mut noisy =
        Trace::new(fake::trace(8, 1, 1.0).columns().iter().map(|column| (column.name.clone(), column.unit)));
    let mut state = 1u64;
    let mut noise = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    for sample in 0..20_000 {
        let row: Vec<f64> = (0..noisy.columns().len())
            .map(|k| if k == 0 { f64::from(sample) * 1e-3 } else { noise() })
            .collect();
        noisy.push(&row);
    }
    check(&figure(&noisy));
}

#[test]
fn logarithmic_panels_keep_every_peak() {
    let trace = fake::trace(1, 9_973, 6.0);
    let (t, values) = (trace.column("t").unwrap(), trace.column("e_l1").unwrap());
    let highest = |values: &mut dyn Iterator<Item = f64>| extremes(values).1;
    for buckets in [1, 7, 480, 20_000] {
        let points = envelope(t, values, buckets);
        let size = bucket_size(values.len(), buckets);
        assert_eq!(points.len(), values.len().div_ceil(size));
        for (point, values) in points.iter().zip(values.chunks(size)) {
            assert_eq!(Some(point.1.to_bits()), highest(&mut values.iter().copied()));
        }
    }
}

#[test]
fn a_diverged_run_is_drawn_to_its_end_and_says_so() {
    let svg = figure(&fake::diverged(2, 5_000));
    check(&svg);
    assert!(curves(&svg) >= 16);
    assert_eq!(texts(&svg).iter().filter(|text| text.contains("not finite after 4 s")).count(), 4);
}

#[test]
fn empty_and_constant_traces_are_figures_too() {
    check(&figure(&Trace::default()));
    check(&figure(&fake::trace(2, 1, 1.0)));
    let mut still = Trace::new(["t", "q_l1", "e_l1", "u_m1"].map(|name| (name.to_owned(), "")));
    for sample in 0..100 {
        still.push(&[f64::from(sample), 0.0, 0.0, 0.0]);
    }
    check(&figure(&still));
    check(&comparison(&[]).svg());
}

#[test]
fn decimation_keeps_both_extremes_of_every_bucket() {
    let trace = fake::trace(1, 9_973, 6.0);
    let t = trace.column("t").unwrap();
    for name in ["u_m1", "e_l1", "q_m1"] {
        let values = trace.column(name).unwrap();
        for buckets in [1, 7, 100, 480] {
            let points = decimate(t, values, buckets);
            assert!(points.len() <= 2 * buckets + 2);
            assert!(points.is_sorted_by(|a, b| a.0 <= b.0));
            let size = bucket_size(values.len(), buckets);
            for (t, values) in t.chunks(size).zip(values.chunks(size)) {
                let kept = points.iter().filter(|point| t.contains(&point.0)).map(|point| point.1);
                assert_eq!(extremes(kept), extremes(values.iter().copied()));
            }
        }
    }
}

/// A signal that comes sample by sample has the envelope of the whole one, in every bucket that it kept, at every size.
#[test]
fn thinned_signals_keep_both_extremes_in_bounded_memory() {
    let mut state = 7_u64;
    let mut noise = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    for most in [8, 10, 64, 1000] {
        let kept = (most / 4).max(2) * 4;
        for count in [0, 1, 2, 7, 8, 9, 16, 17, 63, 64, 65, 1000, 1001, 4096, 20_011] {
            let samples: Vec<(f64, f64)> = (0..count)
                .map(|k| (1e-3 * f64::from(k), if k % 997 == 3 { 1e3 * noise() } else { noise() }))
                .collect();
            let mut thinned = Thinned::new(most);
            for &(t, value) in &samples {
                thinned.push(t, value);
            }
            let points = thinned.points();
            assert_eq!(thinned.samples(), samples.len());
            if samples.len() <= kept {
                assert_eq!(points, samples, "few samples stay as they are");
                continue;
            }
            assert!(
                points.len() <= kept + 4 && points.len() > kept / 2,
                "{} of {count} at {most}",
                points.len()
            );
            assert!(points.is_sorted_by(|a, b| a.0 < b.0), "in their order, each once");
            assert!(points.iter().all(|point| samples.contains(point)), "none is made up");
            assert_eq!((points[0], points.last()), (samples[0], samples.last()));
            // The buckets are the same all along: 4, 8, 16, … samples.
            let size = (2..32).map(|power| 1_usize << power).find(|size| samples.len() / size * 2 <= kept);
            for bucket in samples.chunks(size.expect("a power")) {
                let (from, to) = (bucket[0].0, bucket[bucket.len() - 1].0);
                let inside =
                    points.iter().filter(|point| (from..=to).contains(&point.0)).map(|point| point.1);
                assert_eq!(
                    extremes(inside),
                    extremes(bucket.iter().map(|sample| sample.1)),
                    "{count} at {most}"
                );
            }
        }
    }
}

#[test]
fn thinned_signals_end_before_what_is_no_number() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for end in [0, 3, 8, 9, 500] {
            let mut thinned = Thinned::new(8);
            let value = |k: u32| f64::from(k).sin();
            for k in 0..1000 {
                thinned.push(f64::from(k), if k == end { bad } else { value(k) });
            }
            let points = thinned.points();
            assert_eq!(thinned.samples(), end as usize);
            assert_eq!(points.last().copied(), end.checked_sub(1).map(|k| (f64::from(k), value(k))));
            assert_eq!(extremes(points.iter().map(|point| point.1)), extremes((0..end).map(value)));
        }
    }
}

/// The peaks of a long run are in its figure, which says when they were; the first instant that is not a number is, too.
#[test]
fn long_runs_are_drawn_with_every_peak() {
    let columns = ["t", "q_l1", "e_l1", "u_m1"].map(|name| (name.to_owned(), ""));
    let long = |end: u32| {
        let mut trace = Trace::new(columns.clone());
        for k in 0..300_000 {
            let wave = (1e-3 * f64::from(k)).sin();
            let torque = if k == 123_457 { -777.0 } else { wave };
            trace.push(&[1e-3 * f64::from(k), wave, 1e-3 * wave, if k < end { torque } else { f64::NAN }]);
        }
        four_panel(&Sketch::of(&trace), &FigureOptions::default()).svg()
    };
    let whole = long(u32::MAX);
    check(&whole);
    let said = |svg: &str, words: &str| texts(svg).iter().filter(|text| text.contains(words)).count();
    assert_eq!(said(&whole, "the extremes of each 16 ms, peak 777.0 N m at 123 s"), 1, "{:?}", texts(&whole));
    assert_eq!(said(&long(200_001), "not finite after 200 s"), 4);
}

/// Smallest and largest value, bit by bit: nothing is rounded on the way.
fn extremes(values: impl Iterator<Item = f64>) -> (Option<u64>, Option<u64>) {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    (values.first().copied().map(f64::to_bits), values.last().copied().map(f64::to_bits))
}

#[test]
fn titles_are_text() {
    let trace = fake::trace(1, 100, 6.0);
    let title = "<script>alert(1)</script> & $\\frac{1}{2}$ \u{0}".repeat(3);
    let svg = four_panel(
        &Sketch::of(&trace),
        &FigureOptions { title: title.clone(), subtitle: title.clone(), ..FigureOptions::default() },
    )
    .svg();
    check(&svg);
    assert!(!svg.contains("<script") && texts(&svg)[0].contains("$\\frac{1}{2}$"));
    check(&comparison(&[("<script>", &Sketch::of(&trace))]).svg());
}

#[test]
fn the_comparison_names_each_run_once() {
    let traces = [fake::trace(2, 4_000, 2.0), fake::trace(2, 6_000, 5.0), fake::diverged(2, 5_000)];
    let [tanh, linear, coupled] = traces.each_ref().map(Sketch::of);
    let svg = comparison(&[("tanh", &tanh), ("linear", &linear), ("coupled-tanh", &coupled)]).svg();
    check(&svg);
    assert_eq!(curves(&svg), 3);
    for name in ["tanh", "linear", "coupled-tanh"] {
        assert_eq!(texts(&svg).iter().filter(|text| *text == name).count(), 1);
    }
}

#[test]
fn a_comparison_that_leaves_time_out_says_so() {
    let fast = Sketch::of(&fake::trace(2, 10_000, 30.0));
    let said = |runs: &[(&str, &Sketch)]| {
        texts(&comparison(runs).svg()).iter().any(|text| text.contains("of 10 s; after that"))
    };
    assert!(said(&[("fast", &fast)]));
    assert!(!said(&[("fast", &fast), ("diverged", &Sketch::of(&fake::diverged(2, 10_000)))]));
    assert!(!said(&[("slow", &Sketch::of(&fake::trace(2, 10_000, 0.5)))]));
}

#[test]
fn pictures_are_1600_wide_and_bad_ones_are_errors() {
    let picture =
        four_panel(&Sketch::of(&fake::trace(2, 1_000, 6.0)), &FigureOptions::default()).png().unwrap();
    assert_eq!(&picture[1..4], b"PNG");
    assert_eq!(u32::from_be_bytes(picture[16..20].try_into().unwrap()), 1600);
    let sketch = Sketch::of(&fake::trace(1, 10, 1.0));
    let names: Vec<String> = (0..6000).map(|run| format!("run {run}")).collect();
    let runs: Vec<(&str, &Sketch)> = names.iter().map(|name| (name.as_str(), &sketch)).collect();
    let error = comparison(&runs).png().unwrap_err();
    assert!(error.height > 10.0 * error.width, "{error}");
}

/// A line for the links and one for the motors, in the panel of all joints or in that of each, in front of their numbers.
#[test]
fn what_errors_come_down_to_is_a_line_and_in_the_legend() {
    for (joints, lines) in [(2, 2), (5, 10)] {
        let sketch = Sketch::of(&fake::trace(joints, 3_000, 6.0));
        let drawn = |ultimate| {
            let svg = run_figure(&sketch, &FigureOptions { ultimate, ..FigureOptions::default() }).svg();
            check(&svg);
            svg
        };
        let [mut links, mut motors] = [1e-3, 1e-2].map(|error| vec![error; joints]);
        (links[1], motors[1]) = (1.25e-3, 2e-2);
        let found =
            Ultimate { from: 2.0, links, motors, link_momenta: Vec::new(), motor_momenta: Vec::new() };
        let (without, with) = (drawn(None), drawn(Some(found.clone())));
        assert_eq!(curves(&with), curves(&without) + lines);
        let said = texts(&with);
        for entry in ["largest eₗ from 2 s on: 1.25 mrad", "largest eₘ from 2 s on: 20.0 mrad"] {
            assert!(said.iter().any(|text| text == entry), "{entry} in {said:?}");
        }
        // Laws without motor errors have half of them.
        let links = drawn(Some(Ultimate { motors: Vec::new(), ..found }));
        assert_eq!(curves(&links), curves(&without) + lines / 2);
        assert!(!texts(&links).iter().any(|text| text.contains("largest eₘ")));
    }
}

fn report() -> RunsReport {
    let trace = fake::trace(2, 3_000, 6.0);
    let run = |name: &str| RunReport {
        summary: fake::summary(name),
        figure_svg: figure(&trace),
        description: "<b>A run".to_owned(),
        warning: (name == "linear").then(|| "<i>wild".to_owned()),
    };
    RunsReport {
        title: "<script>title</script>".to_owned(),
        verdict: Some(Verdict { good: Some(true), words: "<u>all well".to_owned() }),
        motion: Some("<script>move()</script>".to_owned()),
        introduction: "One.\n\nTwo & three.".to_owned(),
        runs: vec![run("<script>name</script>"), run("linear")],
        comparison_svg: Some(comparison(&[("tanh", &Sketch::of(&trace))]).svg()),
        certificates: vec![CertificateReport {
            summary: proof(),
            phi: "<script>phi</script>".to_owned(),
            file: Some("<script>.certificate.json".to_owned()),
        }],
        practical: vec![practical()],
        assumptions: vec![AssumedNumber {
            file: "robots/<script>.toml".to_owned(),
            key: "joints.stiffness".to_owned(),
            value: "9, 4 N m/rad".to_owned(),
            note: "not in the paper's table".to_owned(),
        }],
        provenance: vec!["flexure 0.1.0".to_owned()],
    }
}

fn practical() -> Practical {
    let errors = vec![1.25e-3, 2e-3];
    let ultimate = Ultimate {
        from: 3.7,
        links: errors.clone(),
        motors: errors.clone(),
        link_momenta: errors.clone(),
        motor_momenta: errors,
    };
    Practical {
        name: "<script>practical".to_owned(),
        phi: "tanh".to_owned(),
        joints: vec!["<script>".to_owned(), "elbow".to_owned()],
        steps: vec![5e-4, 4e-4],
        alone: [("encoder", ultimate.clone())].into(),
        ultimate,
    }
}

fn proof() -> ProofSummary {
    let scenario = load_scenario("two-link-tanh").unwrap();
    ProofSummary::new(&scenario, &prove(&scenario, &Question::default()).unwrap(), None)
}

#[test]
fn proofs_fit_100_columns() {
    let table = certificate_table(&[proof()], WIDTH);
    assert!(table.lines().all(|line| line.chars().count() <= 100), "{table}");
    let text = proof_table(&proof(), WIDTH);
    for line in ["region", "invariant", "start", "mass matrix", "tightness", "measures", "structure"] {
        assert!(text.contains(&format!("\n{line} ")), "{line} in\n{text}");
    }
}

#[test]
fn the_page_escapes_what_users_write() {
    let page = html(&report());
    assert!(!page.contains("<script") && !page.contains("<b>A run"));
    assert!(page.contains("&lt;script&gt;name&lt;/script&gt;"));
}

#[test]
fn the_page_stands_alone_and_comes_out_the_same() {
    let page = html(&report());
    for reference in ["src=", "href=\"http", "@import", "url(", "<link"] {
        assert!(!page.contains(reference), "{reference}");
    }
    // Namespaces of the figures are names, not addresses.
    assert_eq!(page.matches("://").count(), page.matches("xmlns=\"http://www.w3.org/2000/svg\"").count());
    assert!(!page.contains("0.123"), "the wall-clock time has no place in a reproducible page");
    assert_eq!(page, html(&report()));
    assert!(page.contains("69.0") && page.contains("variational pH"), "the certificate's row");
    assert!(
        page.contains("encoder alone") && page.contains("an encoder step is 0.5 and 0.4 mrad"),
        "what errors come down to"
    );
}

#[test]
fn the_terminal_table_fits_100_columns() {
    let long = fake::summary("a-scenario-with-quite-a-long-name-in-it");
    let table = summary_table(&[fake::summary("paper-tanh"), long], WIDTH);
    assert!(table.lines().all(|line| line.chars().count() <= 100), "{table}");
    assert!(table.contains("5790") && table.contains("123×10⁻⁹") && !table.contains('\u{1b}'), "{table}");
    assert!(!table.contains("proved") && !table.contains("limit"), "no run has them: {table}");
    let longest = Summary {
        phi: Some("coupled-tanh".to_owned()),
        max_abs_e_l: 5.12e-6,
        max_abs_u_m: 164e6,
        rate_certified: Some(2.5),
        ..fake::summary("two-link-coupled-tanh-smooth")
    };
    let table = summary_table(std::slice::from_ref(&longest), WIDTH);
    assert!(table.lines().all(|line| line.chars().count() <= 100), "{table}");
    assert!(table.contains(" two-link-coupled-tanh-smooth ") && table.contains("2.50"), "{table}");
    let limited = summary_table(&[Summary { saturated_fraction: 0.25, ..longest }], WIDTH);
    assert!(limited.contains("limit") && limited.contains("25.0"), "{limited}");
    assert!(limited.lines().all(|line| line.chars().count() <= 100), "{limited}");
}
