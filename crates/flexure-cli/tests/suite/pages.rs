//! `--page`: the answer as a page, whose mark says what the exit code says.

use crate::command::{Outcome, Place, altered};

/// What the page says of the answer.
fn mark(page: &str) -> &'static str {
    ["✓ good", "✕ bad", "– no verdict"]
        .into_iter()
        .find(|mark| page.contains(&format!("<strong>{mark}</strong>")))
        .unwrap_or_else(|| panic!("no verdict in {page}"))
}

/// Runs a command for a page, which comes out with its picture, and returns how it ended and the page.
#[track_caller]
fn paged(place: &Place, args: &[&str], stem: &str) -> (Outcome, String) {
    let mut all = args.to_vec();
    all.extend(["--page", "pages"]);
    let outcome = place.run(&all);
    let names = place.names("pages");
    for ending in ["html", "svg", "png"] {
        assert!(names.contains(&format!("{stem}.{ending}")), "{names:?} {outcome:?}");
    }
    let page = place.read(&format!("pages/{stem}.html"));
    assert!(outcome.stdout.contains(&format!("wrote pages/{stem}.html")), "{}", outcome.stdout);
    // Nothing that a reader cannot make anything of, and every picture is in the page.
    let words: Vec<&str> = page.split(|c: char| !c.is_alphanumeric()).collect();
    assert!(!words.contains(&"NaN") && !words.contains(&"inf"), "{page}");
    assert!(page.contains("<svg") && !page.contains("src=\"http"));
    (outcome, page)
}

#[test]
fn a_proof_is_good_only_if_it_is_about_the_loop_in_the_file() {
    let place = Place::new();
    let out = ["--out", "pages/c.json"];
    let certify = |scenario: &str, more: &[&str]| {
        let args = [&["certify", scenario][..], &out, more].concat();
        let (outcome, page) = paged(&place, &args, &format!("{scenario}.certify"));
        (outcome.code, mark(&page), page)
    };
    let (code, good, page) = certify("two-link-tanh", &["--no-tube"]);
    assert_eq!((code, good), (Some(0), "✓ good"));
    assert!(page.contains("Proved in continuous time") && page.contains("href=\"c.json\""), "{page}");
    assert!(page.contains("invariant") && page.contains("joint2"), "{page}");
    // The same answer is the same page, wherever it goes.
    let elsewhere = place.path().join("elsewhere");
    let folder = elsewhere.to_str().unwrap();
    let certificate = elsewhere.join("c.json");
    place
        .run(&[
            "certify",
            "two-link-tanh",
            "--page",
            folder,
            "--out",
            certificate.to_str().unwrap(),
            "--no-tube",
        ])
        .done();
    assert_eq!(place.read("elsewhere/two-link-tanh.certify.html"), page);
    let (code, open, page) = certify("two-link-hardware", &["--no-tube"]);
    assert_eq!((code, open), (Some(0), "– no verdict"));
    assert!(
        page.contains("of the ideal loop only") && page.contains("velocity-filter, saturation"),
        "{page}"
    );
    assert_eq!(certify("two-link-hardware", &["--no-tube", "--strict"]).1, "✕ bad");
    let (code, bad, page) = certify("two-link-tanh", &["--rate", "99"]);
    assert_eq!((code, bad), (Some(1), "✕ bad"));
    assert!(page.contains("Refuted: ") && !page.contains("id=\"rates\""), "{page}");
}

#[test]
fn a_loop_that_is_unstable_as_sampled_is_bad_whatever_is_proved() {
    let place = Place::new();
    place.scenario("slow.toml", &[("control_period = 0.001", "control_period = 0.01")]);
    let (outcome, page) = paged(&place, &["certify", "slow.toml", "--out", "c.json"], "slow.certify");
    assert_eq!((outcome.code, mark(&page)), (Some(1), "✕ bad"));
    assert!(page.contains("Unstable as sampled: spectral radius"), "{page}");
}

#[test]
fn a_run_has_a_page() {
    let place = Place::new();
    let args = ["run", "two-link-tanh", "--out", "pages", "--view"];
    let (outcome, page) = paged(&place, &args, "two-link-tanh.run");
    let expected = if outcome.code == Some(0) { "✓ good" } else { "✕ bad" };
    assert_eq!(mark(&page), expected);
    assert!(
        page.contains("proved bound of eₗ in continuous time (here torques are held)")
            && page.contains("No measure of the run exceeds")
    );
    assert!(page.contains("href=\"two-link-tanh.csv\"") && page.contains("href=\"two-link-tanh.view.html\""));
    // Elsewhere there is nothing to link to; what is proved is proved of the loop in the file.
    let args = ["run", "two-link-hardware", "--set", "duration=1", "--out", "out"];
    let (outcome, page) = paged(&place, &args, "two-link-hardware.run");
    assert_eq!(mark(&page), if outcome.code == Some(0) { "✓ good" } else { "✕ bad" });
    assert!(!page.contains("href=\"two-link-hardware.csv\"") && !page.contains("proved bound"), "{page}");
    assert!(page.contains("outside of them stand, in this scenario: encoder, velocity-filter"), "{page}");
    let json =
        place.run(&["run", "two-link-hardware", "--set", "duration=1", "--page", "pages", "--json"]).json();
    assert_eq!(json["pages"][0], "pages/two-link-hardware.run.html");
}

/// A certificate says nothing of a slide beyond its travel, and so the figure and the numbers of a run that is there have nothing proved.
#[test]
fn nothing_is_proved_of_a_run_beyond_the_travel_of_a_slide() {
    let place = Place::new();
    let robot = "name = \"rp\"\n[links]\nkind = \"tree\"\n\
        [[links.joint]]\nname = \"turn\"\nkind = \"revolute\"\naxis = [0.0, 0.0, 1.0]\nmass = 1.0\ncom = [0.0, 0.0, 0.0]\n\
        inertia = [0.05, 0.0, 0.0, 0.05, 0.0, 0.05]\n\
        [[links.joint]]\nname = \"slide\"\nparent = \"turn\"\nkind = \"prismatic\"\naxis = [1.0, 0.0, 0.0]\nmass = 3.0\n\
        com = [0.0, 0.0, 0.0]\ninertia = [0.02, 0.0, 0.0, 0.02, 0.0, 0.02]\n\
        [joints]\nstiffness = [2000.0, 5000.0]\nmotor_inertia = [0.3, 2.0]\nlink_damping = 0.1\nmotor_damping = 1.0\n\
        [joints.slide]\nposition_lower = -0.03\nposition_upper = 0.03\n";
    let scenario = "robot = \"rp.toml\"\nduration = 1.0\ncontrol_period = 0.0005\n\
        [initial]\nq_l = [0.3, 0.02]\nq_m = [0.3, 0.02]\n\
        [reference]\nkind = \"sine\"\namplitude = [0.2, 0.005]\nfrequency = [2.0, 1.5]\n\
        [controller]\nkind = \"vcbc\"\nphi = \"linear\"\n";
    place
        .write("rp.toml", robot)
        .write("inside.toml", scenario)
        .write("beyond.toml", scenario.replace("0.02", "0.49"));
    let (_, page) = paged(&place, &["run", "inside.toml"], "inside.run");
    assert!(page.contains("proved bound of eₗ"), "{page}");
    let (outcome, page) = paged(&place, &["run", "beyond.toml"], "beyond.run");
    assert!(!page.contains("proved bound of eₗ"), "{page}");
    assert!(page.contains("Warning: joint slide: link position exceeds position_upper"), "{page}");
    assert!(!outcome.stdout.contains("proved"), "{outcome:?}");
}

/// A page is not put where the run has its files.
#[test]
fn a_page_of_a_run_has_a_place_of_its_own() {
    let place = Place::new();
    let args = ["run", "pendulum-tanh", "--out", "x", "--page", "x/pendulum-tanh.csv"];
    let outcome = place.run(&args);
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
    outcome.said(&["is what --out writes, and where the page goes"]);
    assert!(place.names("x").is_empty(), "{:?}", place.names("x"));
}

#[test]
fn what_has_no_picture_has_a_page_that_says_why() {
    let place = Place::new();
    place.jumping("quintic.toml");
    let outcome = place.run(&["certify", "quintic.toml", "--out", "c.json", "--page", "pages"]);
    assert_eq!(place.names("pages"), ["quintic.certify.html"], "{outcome:?}");
    assert!(
        place.read("pages/quintic.certify.html").contains("There is no picture of this loop"),
        "{outcome:?}"
    );
}

#[test]
fn tuned_gains_are_good_if_everything_that_is_asked_is_kept() {
    let place = Place::new();
    let args = ["tune", "two-link-hardware", "--budget", "3", "--out", "tuned.toml"];
    let (outcome, page) = paged(&place, &args, "two-link-hardware.tune");
    assert_eq!((outcome.code, mark(&page)), (Some(0), "✓ good"));
    assert!(page.contains("What it bears") && page.contains("joint2"), "{page}");
    place.write("fast.toml", "rate = 1e6\n");
    let (outcome, page) =
        paged(&place, &[&args[..], &["--spec", "fast.toml"]].concat(), "two-link-hardware.tune");
    assert_eq!((outcome.code, mark(&page)), (Some(1), "✕ bad"));
}

#[test]
fn identified_numbers_are_good_if_a_law_can_use_them() {
    let place = Place::new();
    // A motion that hardly loads the springs.
    place.run(&["run", "two-link-tanh-smooth", "--set", "duration=2.0", "--out", "."]).done();
    let args = ["identify", "quanser-2dof", "--log", "two-link-tanh-smooth.csv"];
    let (outcome, page) = paged(&place, &args, "quanser-2dof.identify");
    let is_good = outcome.code == Some(0);
    assert_eq!(mark(&page), if is_good { "✓ good" } else { "✕ bad" }, "{outcome:?}");
    // A name is no path.
    place.write(
        "robot.toml",
        altered(crate::command::ROBOT, &[("name = \"quanser-2dof\"", "name = \"../../x\"")]),
    );
    paged(&place, &["identify", "robot.toml", "--log", "two-link-tanh-smooth.csv"], ".._.._x.identify");
    let json = place.run(&[&args[..], &["--page", "pages", "--json"]].concat()).json();
    assert_eq!(json["pages"][0], "pages/quanser-2dof.identify.html");
    assert!(json["joints"][0]["parameters"][0]["unit"].as_str().is_some());
}

#[test]
fn a_sweep_is_good_if_all_of_it_is_there_and_follows_in_stable_loops() {
    let place = Place::new();
    let sweep = "scenario = \"pendulum-tanh\"\npoints = 4\ndesign = \"latin-hypercube\"\nshard = 2\n\
                 metrics = [\"rms_e_l\", \"sampled_rate\"]\n[set]\nduration = 2.0\n[parameters]\n\
                 \"robot.joints.stiffness\" = { from = 0.9, to = 1.1, relative = true }\n";
    place.write("calm.toml", sweep);
    let (_, page) = paged(&place, &["sweep", "calm.toml", "--out", "rows", "--shards", "0"], "calm.sweep");
    assert_eq!(mark(&page), "– no verdict", "half of the rows");
    let (_, page) = paged(&place, &["sweep", "calm.toml", "--out", "rows"], "calm.sweep");
    assert_eq!(mark(&page), "✓ good", "{page}");
    assert!(page.contains("4 of 4 runs are there; follow their reference: 4. Small errors shrink"), "{page}");
    // From the folder alone the same page.
    let (_, again) = paged(&place, &["sweep", "show", "rows"], "calm.sweep");
    assert_eq!(page, again);
    place.write("blind.toml", altered(sweep, &[(", \"sampled_rate\"", "")]));
    let (_, page) = paged(&place, &["sweep", "blind.toml", "--out", "blind"], "blind.sweep");
    assert_eq!(mark(&page), "– no verdict");
    assert!(page.contains("is not known from the metrics (sampled_rate)"), "{page}");
    // They follow for as long as the runs are, and are unstable.
    let slow = [("duration = 2.0", "duration = 0.05\ncontrol_period = 0.012")];
    place.write("short.toml", altered(sweep, &slow));
    let (_, page) = paged(&place, &["sweep", "short.toml", "--out", "short"], "short.sweep");
    assert_eq!(mark(&page), "– no verdict");
    assert!(page.contains("unstable as sampled"), "{page}");
}

#[test]
fn a_loop_that_is_unstable_as_sampled_is_bad_even_if_nothing_was_decided() {
    let place = Place::new();
    let slow = [
        ("control_period = 0.001", "control_period = 0.01"),
        ("[controller]", "[reference.smooth_start]\nduration = 1.0\n[controller]"),
    ];
    place.scenario("slow.toml", &slow);
    let args = ["certify", "slow.toml", "--out", "c.json", "--disturbance", "1e3"];
    let (outcome, page) = paged(&place, &args, "slow.certify");
    assert_eq!((outcome.code, mark(&page)), (Some(1), "✕ bad"), "{outcome:?}");
}

/// In the place of what `--out` writes a page would end it, and a picture of an older page would be taken for that of the new one.
#[test]
fn pages_end_neither_certificates_nor_stay_with_old_pictures() {
    let place = Place::new();
    for out in ["same", "./same/two-link-tanh.certify.html"] {
        place
            .run(&["certify", "two-link-tanh", "--page", "same", "--out", out])
            .refused(&["where the page goes"]);
    }
    let margins = |more: &[&str]| {
        let args = ["margins", "pendulum-tanh", "--set", "duration=0.3", "--page", "pages"];
        place.run(&[&args[..], more].concat())
    };
    margins(&["--controllers", "vcbc,pd", "--budget", "1"]);
    assert!(
        place.names("pages").contains(&"pendulum-tanh.margins-2.svg".to_owned()),
        "{:?}",
        place.names("pages")
    );
    margins(&[]);
    let names = ["html", "png", "svg"].map(|ending| format!("pendulum-tanh.margins.{ending}"));
    assert_eq!(place.names("pages"), names);
}

#[test]
fn joints_that_slide_are_measured_in_metres() {
    let place = Place::new();
    let slide = "name = \"slide\"\n[links]\nkind = \"tree\"\n[[links.joint]]\nname = \"rail\"\nkind = \"prismatic\"\nmass = 2.0\n\
                 axis = [1.0, 0.0, 0.0]\ncom = [0.0, 0.0, 0.0]\ninertia = [0.01, 0.0, 0.0, 0.01, 0.0, 0.01]\n[joints]\nstiffness = [4000.0]\n\
                 motor_inertia = [1.0]\nlink_damping = [1.0]\nmotor_damping = [4.0]\n\
                 position_lower = -0.2\nposition_upper = 0.2\n";
    let scenario = "robot = \"slide.toml\"\nduration = 1.0\ncontrol_period = 0.001\n[reference]\nkind = \"sine\"\namplitude = [0.05]\n\
                    frequency = [2.0]\n[reference.smooth_start]\nduration = 0.5\n[controller]\nkind = \"vcbc\"\nphi = \"tanh\"\n";
    place.write("slide.toml", slide).write("along.toml", scenario);
    let certify = ["certify", "along.toml", "--out", "c.json", "--error-box", "0.01", "--disturbance", "0.5"];
    let pages = [
        paged(&place, &certify, "along.certify").1,
        paged(&place, &["margins", "along.toml"], "along.margins").1,
        paged(&place, &["tune", "along.toml", "--budget", "2", "--out", "t.toml"], "along.tune").1,
    ];
    for page in pages {
        // Assumptions are quoted from the files, with the units of joints that turn.
        let body = page.split("id=\"assumptions\"").next().unwrap().replace("radius", "");
        let at = body.find("rad").map(|at| &body[at.saturating_sub(80)..(at + 40).min(body.len())]);
        assert!(!body.contains(" rad") && !body.contains("mrad"), "{at:?}");
    }
}

/// Said before the work, with nothing written.
#[test]
fn places_that_a_page_cannot_go_to_are_refused() {
    let place = Place::new();
    place.write("file", "").write("pages/two-link-tanh.certify.html/x", "");
    let long = format!("name = \"{}\"\n", "a".repeat(260));
    place.write("robot.toml", altered(crate::command::ROBOT, &[("name = \"quanser-2dof\"\n", &long)]));
    place.write("log.csv", "t\n0\n1\n");
    let certify = ["certify", "two-link-tanh", "--out", "c.json", "--page"];
    place.run(&[&certify[..], &["file"]].concat()).refused(&["file"]);
    place.run(&[&certify[..], &["file/below"]].concat()).refused(&["file"]);
    place.run(&[&certify[..], &["pages"]].concat()).refused(&["not a regular file"]);
    place
        .run(&["tune", "two-link-hardware", "--budget", "1", "--out", "t.toml", "--page", "file"])
        .refused(&["file"]);
    place.run(&["margins", "pendulum-tanh", "--page", "file"]).refused(&["file"]);
    place.run(&["sweep", "show", "none", "--page", "file"]).refused(&["none"]);
    assert_eq!(place.names("."), ["file", "log.csv", "pages", "robot.toml"]);
}
