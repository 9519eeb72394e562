//! Which instructions this processor has: whether those that the program was built with, and which of several builds of it is the fastest here.

use std::path::{Path, PathBuf};

/// An instruction set of the build that this processor lacks; none if it has all of them. To be asked before anything else: instructions that
/// are lacking end a program without a word.
#[cfg(target_arch = "x86_64")]
pub fn lacking() -> Option<&'static str> {
    use std::arch::x86_64::{__cpuid, __cpuid_count};

    // The detection of the standard library takes the build's word for it.
    let extended = (__cpuid(0).eax >= 7).then(|| __cpuid_count(7, 0).ebx);
    among(__cpuid(1).ecx, extended.unwrap_or(0))
}

/// As on x86-64; elsewhere programs are built for what every processor has.
#[cfg(not(target_arch = "x86_64"))]
pub fn lacking() -> Option<&'static str> {
    None
}

/// The first instruction set of the build that is not among those of the registers ECX of CPUID leaf 1 and EBX of leaf 7.
#[cfg(target_arch = "x86_64")]
fn among(ecx: u32, ebx: u32) -> Option<&'static str> {
    let needed = [
        ("AVX", cfg!(target_feature = "avx"), ecx, 28),
        ("FMA", cfg!(target_feature = "fma"), ecx, 12),
        ("AVX2", cfg!(target_feature = "avx2"), ebx, 5),
        ("BMI2", cfg!(target_feature = "bmi2"), ebx, 8),
        ("AVX-512", cfg!(target_feature = "avx512f"), ebx, 16),
    ];
    let found =
        needed.into_iter().find(|(_, is_built, register, bit)| *is_built && (register >> bit) & 1 == 0);
    found.map(|(name, ..)| name)
}

/// Sets of instructions that programs are built for beyond what every processor of the kind has, the smallest first, by the name that compilers
/// have for them; and whether this processor and its operating system have them.
#[cfg(target_arch = "x86_64")]
fn sets() -> Vec<(&'static str, bool)> {
    let three = is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("fma")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("bmi2")
        && is_x86_feature_detected!("f16c")
        && is_x86_feature_detected!("lzcnt")
        && is_x86_feature_detected!("movbe");
    let four = three
        && is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512bw")
        && is_x86_feature_detected!("avx512cd")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl");
    vec![("x86-64-v3", three), ("x86-64-v4", four)]
}

/// Elsewhere there is one set for all.
#[cfg(not(target_arch = "x86_64"))]
fn sets() -> Vec<(&'static str, bool)> {
    Vec::new()
}

/// The name of the set that this program was built for.
pub const BUILT_FOR: &str = if cfg!(target_feature = "avx512f") {
    "x86-64-v4"
} else if cfg!(target_feature = "avx2") {
    "x86-64-v3"
} else {
    ALL
};

/// What all processors of this kind have, by the name that compilers have for it.
const ALL: &str = if cfg!(target_arch = "x86_64") { "x86-64" } else { std::env::consts::ARCH };

/// The names of the sets that programs are built for here, the smallest first.
pub fn names() -> Vec<&'static str> {
    std::iter::once(ALL).chain(sets().into_iter().map(|(name, _)| name)).collect()
}

/// The build of this `program` for the largest set of instructions that this processor has: the file beside it with the name of the set at its
/// end, as `flexure-x86-64-v4`. None if this one is it. `at_most` is one of the [`names`], of the largest set that may be taken.
pub fn better(program: &Path, at_most: Option<&str>) -> Option<PathBuf> {
    let stem = program.file_stem()?.to_str()?;
    let file = |set: &str| {
        let name = match program.extension().and_then(|extension| extension.to_str()) {
            Some(extension) => format!("{stem}-{set}.{extension}"),
            None => format!("{stem}-{set}"),
        };
        program.with_file_name(name)
    };
    chosen(&sets(), BUILT_FOR, at_most, |set| file(set).is_file()).map(file)
}

/// The last of `sets` that is had, larger than the `own`, no larger than `at_most`, and that there is a build for.
fn chosen<'a>(
    sets: &[(&'a str, bool)],
    own: &str,
    at_most: Option<&str>,
    is_there: impl Fn(&str) -> bool,
) -> Option<&'a str> {
    let place = |name: &str| sets.iter().position(|(set, _)| *set == name).map_or(0, |place| place + 1);
    let allowed = at_most.map_or(sets.len(), place);
    let larger = sets.iter().take(allowed).skip(place(own));
    larger.rev().find(|(set, has)| *has && is_there(set)).map(|(set, _)| *set)
}

#[cfg(test)]
mod choices {
    use super::{BUILT_FOR, chosen};

    const ALL: [(&str, bool); 2] = [("x86-64-v3", true), ("x86-64-v4", true)];
    const SOME: [(&str, bool); 2] = [("x86-64-v3", true), ("x86-64-v4", false)];

    #[test]
    fn the_largest_set_that_is_had_and_built_for_is_chosen() {
        let all = |_: &str| true;
        assert_eq!(chosen(&ALL, "x86-64", None, all), Some("x86-64-v4"));
        assert_eq!(chosen(&SOME, "x86-64", None, all), Some("x86-64-v3"));
        assert_eq!(chosen(&SOME, "x86-64-v3", None, all), None);
        assert_eq!(chosen(&ALL, "x86-64-v4", None, all), None);
        assert_eq!(chosen(&ALL, "x86-64", None, |set| set == "x86-64-v3"), Some("x86-64-v3"));
        assert_eq!(chosen(&ALL, "x86-64", None, |_| false), None);
        assert_eq!(chosen(&[], BUILT_FOR, None, all), None);
    }

    #[test]
    fn no_larger_set_is_chosen_than_was_asked_for() {
        let all = |_: &str| true;
        assert_eq!(chosen(&ALL, "x86-64", Some("x86-64-v3"), all), Some("x86-64-v3"));
        assert_eq!(chosen(&ALL, "x86-64", Some("x86-64"), all), None);
        assert_eq!(chosen(&ALL, "x86-64-v3", Some("x86-64-v3"), all), None);
        assert_eq!(chosen(&ALL, "x86-64-v4", Some("x86-64"), all), None);
    }
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::{among, lacking};

    #[test]
    fn what_runs_here_is_not_lacking_here() {
        assert_eq!(lacking(), None);
        assert_eq!(among(u32::MAX, u32::MAX), None);
    }

    #[test]
    #[cfg(target_feature = "avx2")]
    fn each_set_of_the_build_is_asked_for() {
        assert_eq!(among(0, 0), Some("AVX"));
        assert_eq!(among(!(1 << 12), u32::MAX), Some("FMA"));
        // A processor of 2012: AVX, no AVX2.
        assert_eq!(among(u32::MAX, 0), Some("AVX2"));
    }
}
