//! `flexure certify`: verdicts, exit codes, files, bad input.

use serde_json::Value;

use crate::command::{Place, SCENARIO};

/// theory.md, section 5: the paper's gains on |q̃_i| ≤ 3.
#[test]
fn the_papers_gains_are_certified() {
    let folder = Place::new();
    let found = folder.run(&["certify", "two-link-tanh", "--error-box", "3", "--json"]).done().json();
    let number = |key: &str| found[key].as_f64().unwrap();
    assert_eq!(found["verdict"], "proved");
    let close = |found: f64, exact: f64| assert!(found <= exact && found >= exact * (1.0 - 1e-12), "{found}");
    close(number("contraction_rate"), 0.295_981_114_963_205_7);
    close(number("convergence_rate"), 9.950_547_536_867_305);
    assert!((number("paper_rate") - 0.12685).abs() < 1e-5);
    let blocks =
        ["phi_l", "phi_m", "sigma_l", "sigma_m"].map(|block| found["blocks"][block].as_f64().unwrap());
    assert!((blocks[2] - 69.01315493939306).abs() < 1e-10 && (blocks[3] - 44.34782608695652).abs() < 1e-10);
    assert_eq!(found["region"]["error"].as_array().unwrap().len(), 4);
    assert!(found["assumptions"].as_array().is_some() && found["wall_seconds"].as_f64().is_some());
    let file = folder.path().join(found["file"].as_str().unwrap());
    let certificate: Value = serde_json::from_slice(&std::fs::read(file).unwrap()).unwrap();
    assert_eq!(certificate["format"], "flexure-certificate");
}

/// Every built-in scenario gets a certificate without naming anything; the same bytes each time.
#[test]
fn every_scenario_is_certified() {
    let folder = Place::new();
    let listed = folder.run(&["list", "--json"]).done().json();
    for name in listed["scenarios"].as_object().unwrap().keys() {
        let certified = |file: &str| {
            folder.run(&["certify", name, "--no-tube", "--out", file]).done();
            std::fs::read(folder.path().join(file)).unwrap()
        };
        assert_eq!(certified("a.json"), certified("b.json"), "{name}");
    }
}

/// What is printed is true of the loop in the file: a proof about the law in continuous time says so where that is another loop.
#[test]
fn proofs_of_another_loop_say_so() {
    let folder = Place::new();
    let ideal =
        folder.run(&["certify", "two-link-linear-smooth", "--no-tube", "--strict", "--json"]).done().json();
    assert_eq!(ideal["verdict"], "proved");
    assert_eq!(ideal["left_out"], Value::Array(Vec::new()));
    assert_eq!(ideal["sampled"]["stable"], true);

    let real = folder.run(&["certify", "two-link-hardware", "--no-tube", "--json"]).done().json();
    assert_eq!(real["verdict"], "proved (ideal loop)");
    let left_out: Vec<_> =
        real["left_out"].as_array().unwrap().iter().map(|part| part.as_str().unwrap()).collect();
    assert!(
        ["encoder", "velocity-filter", "saturation", "guard"].iter().all(|part| left_out.contains(part)),
        "{left_out:?}"
    );
    let strict = folder.run(&["certify", "two-link-hardware", "--no-tube", "--strict"]);
    assert_eq!(strict.code, Some(1), "{strict:?}");
    strict.said(&["outside of them stand, in this scenario: encoder"]);
    assert!(strict.stdout.contains("proved (ideal loop)"), "{}", strict.stdout);
    let run = folder.run(&["run", "two-link-hardware", "--json"]).done().json();
    assert_eq!(run["rate_certified"], Value::Null);
    assert_eq!(run["sampled"]["stable"], true);

    // The linear law of the paper, proved everywhere, held for 5 ms.
    folder.write("slow.toml", SCENARIO.replace("control_period = 0.001", "control_period = 0.005"));
    let slow = folder.run(&["certify", "slow.toml", "--error-box", "1", "--json"]);
    assert_eq!(slow.code, Some(1), "{slow:?}");
    slow.said(&["slow.toml:5:18", "unstable", "controller."]);
    let found = slow.json();
    assert_eq!(found["verdict"], "proved for continuous time; unstable as sampled");
    let sampled = &found["sampled"];
    assert!(sampled["spectral_radius"].as_f64().unwrap() > 1.0 && sampled["stable"] == false, "{sampled}");
    assert!(["joint", "gain", "move", "place"].iter().all(|key| sampled[key].is_string()), "{sampled}");
    let checked = folder.run(&["check", "slow.toml", "--json"]);
    assert_eq!(checked.code, Some(1), "{checked:?}");
    assert_eq!(checked.json()[0]["sampled"]["spectral_radius"], sampled["spectral_radius"]);
}

#[test]
fn refuted_is_1_and_undecided_is_3() {
    let folder = Place::new();
    let refuted = folder.run(&["certify", "two-link-tanh", "--error-box", "3", "--rate", "0.2960", "--json"]);
    assert_eq!(refuted.code, Some(1), "{refuted:?}");
    let found = refuted.json();
    assert_eq!((&found["verdict"], &found["file"]), (&Value::from("refuted"), &Value::Null));
    assert!(found["witness"]["rate"].as_f64().unwrap() < 0.2960);
    // Between what is proved for seven joints and what samples show.
    let undecided = folder.run(&["certify", "panda-tanh-smooth", "--error-box", "0.01", "--rate", "4.56645"]);
    assert_eq!(undecided.code, Some(3), "{undecided:?}");
    assert!(undecided.stdout.contains("undecided") && !folder.path().join("out").exists());
}

/// The level of W that holds an initial error: its box is at least that error, and the tanh law's rate is that of the box.
#[test]
fn an_initial_error_gets_the_level_set_that_holds_it() {
    let folder = Place::new();
    let found = folder
        .run(&["certify", "two-link-tanh", "--initial-error", "0.5,0.5,0.1,0.1", "--json"])
        .done()
        .json();
    let error: Vec<f64> =
        found["region"]["error"].as_array().unwrap().iter().map(|e| e.as_f64().unwrap()).collect();
    // ½ (55 + 30)/4 + ½ (70 + 60)/100 = 11.275 J, rounded up to nine digits, and so are the errors that follow.
    let above = |x: f64, exact: f64| x >= exact && x <= exact * (1.0 + 3e-8);
    let level = found["region"]["level"].as_f64().unwrap();
    assert!(above(level, 11.275), "{level}");
    for (e, metric) in error.iter().zip([55.0, 30.0, 70.0, 60.0]) {
        assert!(above(*e, (2.0 * level / metric).sqrt()), "{e}");
    }
    let slope = |e: f64| 1.0 / e.cosh().powi(2);
    let expected = (55.0 * slope(error[0])).min(30.0 * slope(error[1]));
    // Thirteen digits of 40 1/s or so.
    assert!((found["contraction_rate"].as_f64().unwrap() - expected).abs() < 2e-11);
}

/// A disturbance larger than the region can hold is not decided; one that fits gives a tube inside it.
#[test]
fn tubes_lie_inside_the_region() {
    let folder = Place::new();
    let tube = |torque: &str| {
        folder.run(&["certify", "two-link-tanh", "--error-box", "1", "--disturbance", torque, "--json"])
    };
    let found = tube("0.5").done().json();
    let level = |key: &str| found[key]["level"].as_f64().unwrap();
    assert!(level("tube") < level("region") && level("tube") > 0.0);
    assert_eq!(tube("500").code, Some(3));
}

/// Torques on links: a funnel whose bounds grow with them and which says which limits are kept; none for errors of radians, and then
/// nothing is bounded.
#[test]
fn torques_on_links_give_a_funnel() {
    let folder = Place::new();
    let funnel = |torque: &str, json: &[&str]| {
        let asked = ["certify", "two-link-hardware", "--set", "duration=5", "--link-disturbance", torque];
        folder.run(&[&asked, json].concat())
    };
    let largest = |torque: &str| {
        let found = funnel(torque, &["--json"]).done().json()["funnel"].clone();
        assert_eq!(found["verdict"], "proved", "{found}");
        let limits = found["limits"].as_array().unwrap();
        assert!(
            !limits.is_empty() && limits.iter().all(|limit| limit["verdict"]["proved"].is_number()),
            "{limits:?}"
        );
        found["error"].as_array().unwrap()[0].as_f64().unwrap()
    };
    let (small, large) = (largest("0.01"), largest("0.03,0.01"));
    assert!(small < large && large < 0.01, "{small} {large}");
    let outcome = funnel("5", &[]);
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    assert!(outcome.stdout.contains("funnel       none was found"), "{outcome:?}");
    let outcome = funnel("0.01", &["--slabs", "7"]);
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    assert!(outcome.stdout.contains("all 7 slabs of time were used up; --slabs allows more"), "{outcome:?}");
    let json = funnel("5", &["--json"]).json();
    assert!(json["funnel"]["verdict"] == "undecided" && json["along"].is_null(), "{json}");
}

/// Links that are a tenth heavier or lighter have a funnel, and W says nothing of them.
#[test]
fn masses_that_are_off_give_a_funnel() {
    let folder = Place::new();
    let robot = include_str!("../../../../robots/two-link-plausible.toml");
    let scenario = include_str!("../../../../scenarios/two-link-hardware.toml");
    folder.write("arm.toml", scenario.replacen("\"two-link-plausible\"", "\"heavy.toml\"", 1));
    let with = |masses: &str| {
        folder.write("heavy.toml", format!("{robot}\n[tolerances]\nlink_mass = {masses}\n"));
        folder.run(&["certify", "arm.toml", "--set", "duration=5", "--json", "--no-tube"])
    };
    let largest = |masses: &str| {
        let found = with(masses).json();
        assert_eq!(found["funnel"]["verdict"], "proved", "{found}");
        assert!(found["within"].is_null(), "{found}");
        found["funnel"]["error"].as_array().unwrap()[0].as_f64().unwrap()
    };
    let (small, large) = (largest("0.01"), largest("0.1"));
    assert!(3.0 * small < large && large < 0.005, "{small} {large}");
    for (masses, place) in [
        ("1.0", "tolerances.link_mass is 1 for a link_mass of 1 (joint 1), must be less"),
        ("[0.1, 1e400]", "link_mass"),
        ("-0.1", "tolerances.link_mass"),
        ("[0.1, 0.1, 0.1]", "tolerances.link_mass"),
        ("\"10 %\"", "tolerances.link_mass"),
        ("[0.1, nan]", "link_mass"),
    ] {
        let outcome = with(masses);
        assert_eq!(outcome.code, Some(2), "{masses}: {outcome:?}");
        assert!(outcome.stdout.contains(place) || outcome.stderr.contains(place), "{masses}: {outcome:?}");
    }
}

/// The largest torques under which no limit acts do not depend on how they are named, and the limit that is in the way is named.
#[test]
fn torques_grow_up_to_limits() {
    let folder = Place::new();
    let largest = |torque: &str| {
        let asked = ["certify", "two-link-hardware", "--set", "duration=2", "--up-to-limits", "--json"];
        let found = folder.run(&[&asked[..], &["--link-disturbance", torque]].concat()).done().json();
        let funnel = &found["funnel"];
        let limits = funnel["limits"].as_array().unwrap();
        assert!(limits.iter().all(|limit| limit["verdict"]["proved"].is_number()), "{limits:?}");
        let [times, beyond] = [funnel, &funnel["binding"]].map(|of| of["times"].as_f64().unwrap());
        assert!(times < beyond && beyond < 1.04 * times, "{funnel}");
        assert!(!funnel["binding"]["at"].as_str().unwrap().is_empty(), "{funnel}");
        times
    };
    let ratio = largest("0.01") / largest("0.08");
    assert!((7.6..8.4).contains(&ratio), "{ratio}");
    // Of errors of half a radian at the start there is no funnel, however small the torques are.
    let outcome = folder.run(&["certify", "two-link-tanh", "--up-to-limits", "--disturbance", "0.1"]);
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
}

/// A rate of any two solutions while velocity errors keep to a bound, in the file, in the lines and in `--json`; and a link metric that
/// hardens has none but that.
#[test]
fn velocity_errors_with_a_bound_give_a_faster_rate() {
    let folder = Place::new();
    let hardening = "metric_hardening = [55.0, 30.0]\ndamping = [15.0";
    folder.scenario("hardening.toml", &[("damping = [15.0", hardening)]);
    let certify = |scenario: &str, json: &[&str]| {
        let args = [&["certify", scenario, "--error-box", "3", "--velocity-error", "5"], json].concat();
        folder.run(&args).done()
    };
    let found = certify("two-link-tanh", &["--json"]).json();
    let rate = found["stretched"]["rate"].as_f64().unwrap();
    assert!(rate > 19.0 && found["contraction_rate"].as_f64().unwrap() < 0.3, "{rate}");
    assert_eq!(found["stretched"]["velocity_error"].as_array().unwrap().len(), 4);
    let said = certify("two-link-tanh", &[]).stdout;
    let words = "1/s between any two solutions of the virtual system, while both have |q̃_i| ≤ 3 rad and |s_i| ≤ 5 rad/s";
    assert!(said.contains(words), "{said}");
    let verified = folder.run(&["verify", "out/two-link-tanh.certificate.json"]).done().stdout;
    assert!(verified.contains("stretched: 19."), "{verified}");

    let found = certify("hardening.toml", &["--json"]).json();
    assert!(found["contraction_rate"].is_null() && found["stretched"]["rate"].as_f64().unwrap() > 7.0);
    folder.run(&["verify", "out/hardening.certificate.json", "--against", "hardening.toml"]).done();
}

#[test]
fn bad_options_are_told_apart() {
    let folder = Place::new();
    let hardening = |damping: &str| format!("metric_hardening = [1.0, 0.0]\n{damping}");
    let (link, motor) = ("damping = [15.0", "damping = [10.0");
    folder.scenario("hardening.toml", &[(link, &hardening(link))]);
    folder.scenario("motor.toml", &[(motor, &hardening(motor))]);
    folder.scenario("phi.toml", &[("\"tanh\"", "\"tahn\"")]);
    folder.scenario("metric.toml", &[("[55.0, 30.0]", "[55.0, -30.0]")]);
    folder.scenario("continuous.toml", &[("duration", "hold = \"continuous\"\nduration")]);
    folder.jumping("jumping.toml");
    let cases: [(&[&str], &str); 40] = [
        (&["two-link-tanh", "--error-box", "0"], "empty"),
        (&["two-link-tanh", "--error-box", "-1"], "empty"),
        (&["two-link-tanh", "--error-box", "nan"], "magnitude"),
        (&["two-link-tanh", "--error-box", "1e400"], "magnitude"),
        (&["two-link-tanh", "--error-box", "1,2,3"], "1 or 4 numbers"),
        (&["two-link-tanh", "--error-box", "wide"], "invalid"),
        (&["two-link-tanh", "--error-box", "1e-300"], "cannot be represented"),
        (&["two-link-tanh", "--budget", "3"], "--direct"),
        (&["two-link-tanh", "--initial-error", "0"], "empty"),
        (&["two-link-tanh", "--initial-error", "1", "--error-box", "1"], "cannot be used with"),
        (&["two-link-tanh", "--rate", "-1"], "must be > 0"),
        (&["two-link-tanh", "--disturbance", "-1"], "must be >= 0"),
        (&["two-link-tanh", "--disturbance", "1,2,3"], "1 or 2 numbers"),
        (&["two-link-tanh", "--link-disturbance", "-1"], "must be >= 0"),
        (&["two-link-tanh", "--link-disturbance", "1,2,3"], "1 or 2 numbers"),
        (&["two-link-tanh", "--link-disturbance", "nan"], "magnitude"),
        (&["two-link-tanh", "--link-disturbance", "inf"], "magnitude"),
        (&["two-link-tanh", "--up-to-limits"], "not which torques"),
        // What has no funnel at all is refused: nothing would be decided.
        (&["hardening.toml", "--velocity-error", "5", "--link-disturbance", "0.1"], "constant metric"),
        (&["jumping.toml", "--link-disturbance", "0.1"], "third derivative"),
        (&["jumping.toml", "--up-to-limits", "--disturbance", "0.1"], "third derivative"),
        (&["two-link-tanh", "--up-to-limits", "--disturbance", "0"], "not which torques"),
        (&["two-link-tanh", "--disturbance", "0.1", "--slabs", "0"], "must be >= 1"),
        (&["two-link-tanh", "--disturbance", "0.1", "--slabs", "-3"], "unexpected"),
        (&["two-link-tanh", "--disturbance", "0.1", "--slabs", "99999999999999999999"], "invalid"),
        (&["two-link-tanh", "--sampled-tube", "0"], "must be at least 1e-9"),
        (&["two-link-tanh", "--sampled-tube", "-0.1"], "must be at least 1e-9"),
        (&["two-link-tanh", "--sampled-tube", "nan"], "magnitude"),
        (&["two-link-tanh", "--sampled-tube", "1e-5,1e-5,1e-5"], "1 or 2 numbers"),
        (&["two-link-tanh", "--sampled-tube", "narrow"], "invalid"),
        (&["two-link-everything", "--sampled-tube", "1e-5"], "imperfections of kind '"),
        (&["continuous.toml", "--sampled-tube", "1e-5"], "acts in continuous time"),
        (&["two-link-tanh", "--velocity-error", "-1"], "must be >= 0"),
        (&["two-link-tanh", "--velocity-error", "1,2,3"], "1 or 4 numbers"),
        (&["two-link-linear", "--velocity-error", "1"], "stretched"),
        (&["hardening.toml"], "--velocity-error"),
        (&["motor.toml"], "not integrable"),
        (&["phi.toml"], "tahn"),
        (&["metric.toml"], "must be > 0"),
        (&["no-such-scenario"], "no built-in scenario"),
    ];
    for (arguments, complaint) in cases {
        let outcome = folder.run(&[&["certify"], arguments].concat());
        assert_eq!(outcome.code, Some(2), "{arguments:?}: {outcome:?}");
        assert!(outcome.stderr.contains(complaint), "{arguments:?}: {}", outcome.stderr);
        assert!(outcome.stdout.is_empty() && !folder.path().join("out").exists(), "{arguments:?}");
    }
    let unwritable = folder.run(&["certify", "two-link-tanh", "--out", "phi.toml/x.json"]);
    assert_eq!(unwritable.code, Some(2), "{unwritable:?}");
}

/// What the prover writes, the checker accepts, for every robot and every kind of region; and a rate that is raised by a
/// millionth it does not.
#[test]
fn certificates_are_verified() {
    let folder = Place::new();
    let listed = folder.run(&["list", "--json"]).done().json();
    let all: Vec<&str> = listed["scenarios"].as_object().unwrap().keys().map(String::as_str).collect();
    let options: [&[&str]; 3] = [&["--no-tube"], &["--error-box", "0.3"], &["--initial-error", "0.1"]];
    for (i, name) in all.iter().enumerate() {
        let arguments = [&["certify", name, "--out", "a.json"], options[i % 3]].concat();
        folder.run(&arguments).done();
        folder.run(&["verify", "a.json"]).done();
        let mut raised: Value = serde_json::from_str(&folder.read("a.json")).unwrap();
        for key in ["contraction_rate", "convergence_rate"] {
            let rate: f64 = raised[key].as_str().unwrap().parse().unwrap();
            raised[key] = (rate * (1.0 + 1e-6)).to_string().into();
        }
        for block in raised["blocks"].as_array_mut().unwrap() {
            for key in ["contraction", "convergence"] {
                let rate: f64 = block[key].as_str().unwrap().parse().unwrap();
                block[key] = (rate * (1.0 + 1e-6)).to_string().into();
            }
        }
        folder.write("b.json", raised.to_string());
        assert_eq!(folder.run(&["verify", "b.json"]).code, Some(1), "{name}");
    }
    folder
        .run(&["certify", "two-link-tanh", "--error-box", "3", "--disturbance", "0.2", "--out", "a.json"])
        .done();
    folder.run(&["verify", "a.json"]).done();
}

/// Without a region tanh takes what holds the start, if that is more than 1 rad: the run is inside, and the rate that is proved
/// lies below the one sampled along it.
#[test]
fn the_region_that_is_taken_holds_the_run() {
    let folder = Place::new();
    for (scenario, level) in [("two-link-tanh", true), ("two-link-tanh-smooth", false)] {
        let found = folder.run(&["certify", scenario, "--no-tube", "--json"]).done().json();
        assert_eq!(found["start"]["inside"], true, "{scenario}");
        assert_eq!(found["region"]["error"][0].as_f64().unwrap() > 1.0, level, "{scenario}");
        let noted = found["assumptions"]
            .as_array()
            .unwrap()
            .iter()
            .any(|note| note.as_str().unwrap().contains("no region"));
        assert!(noted, "{scenario}");
        let run = folder.run(&["run", scenario, "--json"]).done().json();
        assert!(
            run["rate_certified"].as_f64().unwrap() <= run["rate_pointwise"].as_f64().unwrap(),
            "{scenario}"
        );
    }
}

/// Bounds along the reference are for the level set that the run starts in, not only for the tube that it ends in: a speed that
/// the run reaches is never said not to be.
#[test]
fn limits_count_from_the_start() {
    let folder = Place::new();
    let robot = crate::command::ROBOT.replace("[joints]", "[joints]\nvelocity_limit = [1.2, 1.2]");
    folder.write("arm.toml", robot);
    folder.scenario("s.toml", &[("\"quanser-2dof\"", "\"arm.toml\"")]);
    let arguments = ["--disturbance", "0.05", "--json"];
    // Off the reference at the start: the level set of the start is large, and the run exceeds the limit.
    let far = folder.run(&[&["certify", "s.toml"], &arguments[..]].concat());
    assert_ne!(far.code, Some(0), "{far:?}");
    let found = far.json();
    let (level, start) = (&found["along"]["level"], &found["start"]["level"]);
    assert!(level.as_f64().unwrap() >= start.as_f64().unwrap());
    // A start that the region does not hold: nothing is said.
    let outside =
        folder.run(&[&["certify", "s.toml", "--error-box", "3"], &arguments[..]].concat()).done().json();
    assert_eq!((&outside["along"], &outside["start"]["inside"]), (&Value::Null, &Value::from(false)));
}

/// What the scenario has and the theorem has not is listed.
#[test]
fn what_is_beyond_the_model_is_listed() {
    let folder = Place::new();
    let noted = |scenario: &str, what: &str| {
        let found = folder.run(&["certify", scenario, "--no-tube", "--json"]).done().json();
        found["assumptions"].as_array().unwrap().iter().any(|note| note.as_str().unwrap().contains(what))
    };
    assert!(noted("two-link-tanh", "held for 0.001 s"));
    assert!(noted("tomei-3r-tanh-coupled", "plant.rotor_coupling"));
    assert!(!noted("tomei-3r-tanh", "plant."));
}

/// The budget of the direct engine: exit code 3, the structural certificate written.
#[test]
fn a_spent_budget_is_undecided() {
    let folder = Place::new();
    let outcome =
        folder.run(&["certify", "two-link-tanh", "--direct", "--budget", "0", "--json", "--out", "c.json"]);
    assert_eq!(outcome.code, Some(3), "{outcome:?}");
    let found = outcome.json();
    assert_eq!((&found["verdict"], &found["direct"]["verdict"]), (&"undecided".into(), &"undecided".into()));
    folder.run(&["verify", "c.json"]).done();
}

/// A file that is no certificate is not written over.
#[test]
fn other_files_are_spared() {
    let folder = Place::new();
    folder.scenario("s.toml", &[]);
    let outcome = folder.run(&["certify", "s.toml", "--out", "s.toml"]);
    outcome.refused(&["is no certificate"]);
    assert!(folder.read("s.toml").contains("[controller]"));
    folder.run(&["certify", "s.toml", "--no-tube", "--out", "c.json"]).done();
    folder.run(&["certify", "s.toml", "--no-tube", "--out", "c.json"]).done();
}

/// A place where no certificate can ever be written is told before the proof, not after minutes of it: this one would be refuted.
#[test]
fn a_place_below_a_file_is_refused_before_the_proof() {
    let folder = Place::new();
    folder.write("notes", "mine");
    folder
        .run(&["certify", "two-link-tanh", "--rate", "1000", "--out", "notes/c.json"])
        .refused(&["cannot create files in notes"]);
    assert_eq!(folder.read("notes"), "mine");
}
