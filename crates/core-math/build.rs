//! Compiles the C files for the target's plain instruction set: results and binaries stay portable.

fn main() {
    let files =
        ["atan", "cos", "exp", "log", "log1p", "sin", "sinh", "tanh"].map(|name| format!("c/{name}.c"));
    cc::Build::new()
        .files(files)
        // Every rounding error is accounted for: none may be fused away or moved.
        .flag_if_supported("-ffp-contract=off")
        .flag_if_supported("-frounding-math")
        .cargo_warnings(false)
        .compile("core-math");
    println!("cargo:rerun-if-changed=c");
}
