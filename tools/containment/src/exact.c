/* The floats on either side of an exact value, by MPFR with directed rounding. */

#include <mpfr.h>

typedef int unary(mpfr_t, const mpfr_t, mpfr_rnd_t);
typedef int binary(mpfr_t, const mpfr_t, const mpfr_t, mpfr_rnd_t);

/* ln cosh x for x >= 0: every step increases, so that rounding each of them one way bounds the value. */
static int log_cosh(mpfr_t result, const mpfr_t x, mpfr_rnd_t round)
{
    /* x - ln 2 needs the bits of both: a float lies between 2^-1074 and 2^1024. */
    mpfr_prec_t bits = mpfr_cmp_ui(x, 40) > 0 ? 1300 : 300;
    mpfr_rnd_t other = round == MPFR_RNDD ? MPFR_RNDU : MPFR_RNDD;
    mpfr_t y, z;
    mpfr_inits2(bits, y, z, (mpfr_ptr)0);
    if (bits == 300) {
        /* ln(1 + 2 sinh^2(x/2)) */
        mpfr_div_2ui(y, x, 1, round);
        mpfr_sinh(y, y, round);
        mpfr_sqr(y, y, round);
        mpfr_mul_2ui(y, y, 1, round);
        mpfr_log1p(y, y, round);
    } else {
        /* x - ln 2 + ln(1 + e^-2x), of which the last is between 0 and e^-80 */
        mpfr_const_log2(z, other);
        mpfr_sub(y, x, z, round);
        mpfr_set_d(z, round == MPFR_RNDD ? 0.0 : 0x1p-115, round);
        mpfr_add(y, y, z, round);
    }
    mpfr_set(result, y, round);
    mpfr_clears(y, z, (mpfr_ptr)0);
    return 0;
}

static int reciprocal(mpfr_t result, const mpfr_t x, mpfr_rnd_t round)
{
    return mpfr_ui_div(result, 1, x, round);
}

static unary *const UNARY[] = {mpfr_sqr, reciprocal, mpfr_sqrt, mpfr_exp,  mpfr_log,
                               mpfr_sin, mpfr_cos,   mpfr_tanh, mpfr_atan, log_cosh};
static binary *const BINARY[] = {mpfr_add, mpfr_sub, mpfr_mul, mpfr_div};

/* Below, above: the largest float <= the exact value and the smallest >= it; both NaN where there is none. */
void exact(unsigned operation, double x, double y, double *below, double *above)
{
    static mpfr_t a, b, result;
    static int ready;
    if (!ready) {
        mpfr_inits2(53, a, b, result, (mpfr_ptr)0);
        ready = 1;
    }
    mpfr_set_d(a, x, MPFR_RNDN);
    mpfr_set_d(b, y, MPFR_RNDN);
    const unsigned unaries = sizeof UNARY / sizeof *UNARY;
    for (int up = 0; up < 2; up++) {
        mpfr_rnd_t round = up ? MPFR_RNDU : MPFR_RNDD;
        if (operation < unaries)
            UNARY[operation](result, a, round);
        else
            BINARY[operation - unaries](result, a, b, round);
        *(up ? above : below) = mpfr_get_d(result, round);
    }
}

const char *version(void) { return mpfr_get_version(); }
