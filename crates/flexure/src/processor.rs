//! Whether this processor has the instructions that the program was built with.

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
