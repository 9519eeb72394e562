//! Arms whose mass matrix depends on two angles.

use flexure::prove::engine::verdict::Verdict;
use flexure::prove::question::{Direct, Question, Region, prove};
use flexure::scenario::load_scenario;

/// Both engines, of a rate that flat slopes of tanh decide (3 rad) and one that the momenta of the links do (1 rad).
#[test]
fn what_the_structural_engine_certifies_is_confirmed() {
    let scenario = load_scenario("planar-3r-tanh").expect("built in");
    for error in [3.0, 1.0] {
        let question = Question {
            region: Region::Errors(vec![error; 6]),
            direct: Some(Direct { budget: 10_000 }),
            ..Question::default()
        };
        let proof = prove(&scenario, &question).expect("a v-CBC law");
        let certificate = proof.verdict.proved().expect("a certificate");
        let certified = certificate.contraction_rate.as_ref().expect("a rate").bounds().lo();
        let Some(Verdict::Proved(confirmed)) = &proof.confirmation else {
            panic!("{error} rad: {:?}", proof.confirmation)
        };
        println!("{error} rad: {} 1/s in {} boxes", confirmed.rate, confirmed.boxes);
        assert!(confirmed.rate > certified * (1.0 - 2e-9), "{confirmed:?} of {certified}");
    }
}

/// One box is not enough for what takes thousands.
#[test]
fn a_box_is_not_enough() {
    let scenario = load_scenario("planar-3r-tanh").expect("built in");
    let direct = Some(Direct { budget: 1 });
    let question = Question { region: Region::Errors(vec![3.0; 6]), direct, ..Question::default() };
    let proof = prove(&scenario, &question).expect("a v-CBC law");
    assert!(matches!(proof.confirmation, Some(Verdict::Undecided(_))), "{:?}", proof.confirmation);
}
