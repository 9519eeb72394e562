//! Certificates: verified, a claim refused, or no certificate; never anything else.
#![no_main]

use flexure::verify::{Rejected, verify};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Err(Rejected::False { claim, reason } | Rejected::Malformed { place: claim, reason, .. }) =
        verify(text)
    {
        assert!(!(claim.is_empty() && reason.is_empty()));
    }
});
