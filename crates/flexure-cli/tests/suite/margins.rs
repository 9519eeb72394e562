//! `flexure margins`.

use crate::command::{Place, SCENARIO, altered};

const SMOOTH: &str = "[reference.smooth_start]\nduration = 0.5\n[controller]";

/// Half a second of the paper's arm, joined smoothly.
fn short() -> String {
    altered(SCENARIO, &[("duration = 10.0", "duration = 0.5"), ("[controller]", SMOOTH)])
}

#[test]
fn margins_are_brackets_around_where_the_loop_stops_holding() {
    let place = Place::new();
    place.write("short.toml", short());
    let json = place.run(&["margins", "short.toml", "--json"]).done().json();
    let found = &json["loops"][0];
    // A millisecond of delay more is too much for the paper's gains at 1 kHz.
    let [holds, fails] = ["holds", "fails"].map(|key| found["delay"][key].as_f64().unwrap());
    assert!(holds < fails && fails <= 1e-3 && fails - holds <= 0.01 * fails, "{found}");
    for (low, high) in [("gain_low", "gain_high"), ("stiffness_low", "stiffness_high")] {
        assert!(found[low]["holds"].as_f64().unwrap() < 1.0, "{found}");
        assert!(found[high]["holds"].as_f64().unwrap() > 1.0, "{found}");
    }
    assert!(found["noise"]["holds"].as_f64().unwrap() > 0.0);
    assert!(found["noise_to_torque"].as_f64().unwrap() > 0.0);
    // What decides by runs does not take steps whose errors nobody estimates.
    let midpoint = ["margins", "short.toml", "--json", "--set", "integration=midpoint"];
    assert_eq!(place.run(&midpoint).done().json()["loops"][0], *found);
    let table = place.run(&["margins", "short.toml"]).done().stdout;
    assert!(table.contains("vcbc tanh") && table.lines().all(|line| line.chars().count() <= 110), "{table}");
}

/// The delay up to which a tube is proved is less than the one that is borne, and not much; sensors that a tube does not speak of are refused by name.
#[test]
fn delays_are_proved_beside_those_that_are_simulated() {
    let place = Place::new();
    place.write(
        "short.toml",
        short()
            .replace("duration = 0.5\n[controller]", "duration = 0.1\n[controller]")
            .replace("duration = 0.5", "duration = 0.15"),
    );
    let asked =
        |options: &[&str]| place.run(&[&["margins", "short.toml", "--sampled-tube"], options].concat());
    let json = asked(&["1e-5", "--json"]).done().json();
    let (delay, proved) = (&json["loops"][0]["delay"], &json["loops"][0]["delay_proved"]);
    let [holds, borne] = [&proved["holds"], &delay["holds"]].map(|x| x.as_f64().unwrap());
    assert!(holds <= borne && holds >= 0.7 * borne, "{json}");
    assert!((proved["part"].as_f64().unwrap() - holds / borne).abs() < 1e-12, "{json}");
    assert!(proved["rate"].as_f64().unwrap() > 0.0 && proved["tried"].as_u64().unwrap() > 3, "{json}");
    let said = asked(&["1e-5"]).done().stdout;
    assert!(
        said.contains("ms of delay more, the largest of ")
            && said.contains("% of what it bears in simulation"),
        "{said}"
    );
    for (bad, what) in [("0", "must be at least 1e-9"), ("nan", "sampled tube"), ("1,2,3", "sampled tube")] {
        let outcome = asked(&[bad]);
        assert_eq!(outcome.code, Some(2), "{outcome:?}");
        outcome.said(&[what]);
    }
}

#[test]
fn a_loop_that_diverges_has_no_margins() {
    let place = Place::new();
    let slow = short().replace("control_period = 0.001", "control_period = 0.004");
    place.write("slow.toml", slow.replace("duration = 0.5\n[controller]", "duration = 0.2\n[controller]"));
    let outcome = place.run(&["margins", "slow.toml"]);
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    outcome.said(&["slow.toml", "diverges as it is", "the loop is stable with"]);
}

#[test]
fn questions_that_cannot_be_meant_are_refused() {
    let place = Place::new();
    place.write("short.toml", short());
    let hold = "control_period = 0.001\nhold = \"continuous\"";
    place.write("ideal.toml", short().replace("control_period = 0.001", hold));
    place.run(&["margins", "ideal.toml"]).refused(&["hold is \"continuous\"", "remove hold"]);
    place.run(&["margins", "nowhere"]).refused(&["nowhere"]);
    place.run(&["margins", "short.toml", "--controllers", "pdd"]).refused(&["pdd", "did you mean"]);
    place.run(&["margins", "short.toml", "--controllers", "pd", "--budget", "0"]).refused(&["budget is 0"]);
}

#[test]
fn a_folder_gets_a_page_with_its_picture() {
    let place = Place::new();
    place.write("short.toml", short());
    let text = place.run(&["margins", "short.toml", "--page", "there"]).done().stdout;
    assert_eq!(place.names("there"), ["short.margins.html", "short.margins.png", "short.margins.svg"]);
    assert!(text.contains("wrote there/short.margins.html"), "{text}");
    let page = place.read("there/short.margins.html");
    assert!(page.contains("✓ good") && page.contains("of delay more"), "{page}");
    let json = place.run(&["margins", "short.toml", "--page", "there", "--json"]).done().json();
    assert_eq!(json["pages"][0], "there/short.margins.html");
    assert_eq!(place.read("there/short.margins.html"), page);
    place.write("file", "");
    place.run(&["margins", "short.toml", "--page", "file"]).refused(&["file"]);
}
