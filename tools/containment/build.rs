//! The part that speaks to MPFR.

fn main() {
    println!("cargo::rerun-if-changed=src/exact.c");
    cc::Build::new().file("src/exact.c").warnings_into_errors(true).compile("exact");
    println!("cargo::rustc-link-lib=mpfr");
    println!("cargo::rustc-link-lib=gmp");
}
