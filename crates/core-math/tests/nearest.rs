//! Against mpmath: arguments of every magnitude, and those of many thousands whose values lie closest to the middle between
//! two floats. `tools/nearest_oracle.py` writes the table.

const TABLE: &str = include_str!("nearest.csv");

fn function(name: &str) -> fn(f64) -> f64 {
    match name {
        "exp" => core_math::exp,
        "log" => core_math::log,
        "log1p" => core_math::log1p,
        "sin" => core_math::sin,
        "cos" => core_math::cos,
        "tanh" => core_math::tanh,
        "sinh" => core_math::sinh,
        "atan" => core_math::atan,
        _ => panic!("the table holds an unknown function {name}"),
    }
}

#[test]
fn every_value_is_the_nearest_float() {
    for line in TABLE.lines() {
        let [name, x, nearest] = line.split(',').collect::<Vec<_>>()[..] else { panic!("{line}") };
        let (x, nearest): (f64, f64) = (x.parse().unwrap(), nearest.parse().unwrap());
        let value = function(name)(x);
        assert_eq!(value.to_bits(), nearest.to_bits(), "{name} {x:e} = {value:e}, not {nearest:e}");
    }
    assert_eq!(TABLE.lines().count(), 8 * 200);
}

/// The ends of the ranges.
#[test]
fn special_values_are_exact() {
    let infinity = f64::INFINITY;
    for (name, x, y) in [
        ("exp", 0.0, 1.0),
        ("exp", -infinity, 0.0),
        ("exp", 710.0, infinity),
        ("log", 1.0, 0.0),
        ("log", 0.0, -infinity),
        ("log1p", -1.0, -infinity),
        ("cos", 0.0, 1.0),
        ("tanh", infinity, 1.0),
        ("sinh", -infinity, -infinity),
        ("sin", -0.0, -0.0),
        ("atan", 0.0, 0.0),
    ] {
        let value = function(name)(x);
        assert_eq!(value.to_bits(), f64::to_bits(y), "{name} {x:e} = {value:e}");
    }
    for name in ["exp", "log", "log1p", "sin", "cos", "tanh", "sinh", "atan"] {
        assert!(function(name)(f64::NAN).is_nan(), "{name} of NaN");
    }
}
