//! Twins of `shading/math`, in the order of `shaders/kernels/parity/math.comp`.

use super::{Family, Twin};
use crate::shading::math::*;
use crate::verify::inputs::Domain::{Below, Bits, Exponent, Normal, Range};

/// Two vectors of ordinary size.
const TWO_VECTORS: [crate::verify::inputs::Domain; 6] = [Exponent(-20, 20); 6];

pub const FAMILY: Family = Family {
    kernel: "parity/math",
    twins: &[
        Twin {
            name: "rcp",
            domains: &[Bits],
            run: |i, o| {
                o.f(rcp(i.f(0)));
            },
        },
        Twin {
            name: "div",
            domains: &[Bits, Bits],
            run: |i, o| {
                o.f(div(i.f(0), i.f(1)));
            },
        },
        Twin {
            name: "rsqrt",
            domains: &[Bits],
            run: |i, o| {
                o.f(rsqrt(i.f(0)));
            },
        },
        Twin {
            name: "sqrt_",
            domains: &[Bits],
            run: |i, o| {
                o.f(sqrt_(i.f(0)));
            },
        },
        Twin {
            name: "sin_turns",
            domains: &[Bits],
            run: |i, o| {
                o.f(sin_turns(i.f(0)));
            },
        },
        Twin {
            name: "cos_turns",
            domains: &[Range(-4.0, 4.0)],
            run: |i, o| {
                o.f(cos_turns(i.f(0)));
            },
        },
        Twin {
            name: "sin_",
            domains: &[Range(-9000.0, 9000.0)],
            run: |i, o| {
                o.f(sin_(i.f(0)));
            },
        },
        Twin {
            name: "cos_",
            domains: &[Bits],
            run: |i, o| {
                o.f(cos_(i.f(0)));
            },
        },
        Twin {
            name: "exp2_",
            domains: &[Range(-150.0, 150.0)],
            run: |i, o| {
                o.f(exp2_(i.f(0)));
            },
        },
        Twin {
            name: "exp_",
            domains: &[Bits],
            run: |i, o| {
                o.f(exp_(i.f(0)));
            },
        },
        Twin {
            name: "log2_",
            domains: &[Bits],
            run: |i, o| {
                o.f(log2_(i.f(0)));
            },
        },
        Twin {
            name: "log_",
            domains: &[Bits],
            run: |i, o| {
                o.f(log_(i.f(0)));
            },
        },
        Twin {
            name: "pow_",
            domains: &[Range(0.0, 2.0), Exponent(-10, 10)],
            run: |i, o| {
                o.f(pow_(i.f(0), i.f(1)));
            },
        },
        Twin {
            name: "atan2_",
            domains: &[Bits, Bits],
            run: |i, o| {
                o.f(atan2_(i.f(0), i.f(1)));
            },
        },
        Twin {
            name: "acos_",
            domains: &[Range(-1.1, 1.1)],
            run: |i, o| {
                o.f(acos_(i.f(0)));
            },
        },
        Twin {
            name: "asin_",
            domains: &[Bits],
            run: |i, o| {
                o.f(asin_(i.f(0)));
            },
        },
        Twin {
            name: "exponent_",
            domains: &[Bits],
            run: |i, o| {
                o.u(exponent_(i.f(0)) as u32);
            },
        },
        Twin {
            name: "ldexp_",
            domains: &[Exponent(-60, 60), Below(0)],
            run: |i, o| {
                o.f(ldexp_(i.f(0), i.u(1) as i32));
            },
        },
        Twin {
            name: "min_ max_",
            domains: &[Normal, Normal],
            run: |i, o| {
                o.f(min_(i.f(0), i.f(1))).f(max_(i.f(0), i.f(1)));
            },
        },
        Twin {
            name: "clamp_",
            domains: &[Normal, Range(-1.0, 0.0), Range(0.0, 1.0)],
            run: |i, o| {
                o.f(clamp_(i.f(0), i.f(1), i.f(2)));
            },
        },
        Twin {
            name: "mix_",
            domains: &[Exponent(-20, 20), Exponent(-20, 20), Range(0.0, 1.0)],
            run: |i, o| {
                o.f(mix_(i.f(0), i.f(1), i.f(2)));
            },
        },
        Twin {
            name: "mix3_",
            domains: &[
                Exponent(-20, 20),
                Exponent(-20, 20),
                Exponent(-20, 20),
                Exponent(-20, 20),
                Exponent(-20, 20),
                Exponent(-20, 20),
                Range(0.0, 1.0),
            ],
            run: |i, o| {
                o.v3(mix3_(i.v3(0), i.v3(3), i.f(6)));
            },
        },
        Twin {
            name: "dot2",
            domains: &[Exponent(-20, 20); 4],
            run: |i, o| {
                o.f(dot2(i.v2(0), i.v2(2)));
            },
        },
        Twin {
            name: "dot3",
            domains: &TWO_VECTORS,
            run: |i, o| {
                o.f(dot3(i.v3(0), i.v3(3)));
            },
        },
        Twin {
            name: "cross3",
            domains: &TWO_VECTORS,
            run: |i, o| {
                o.v3(cross3(i.v3(0), i.v3(3)));
            },
        },
        Twin {
            name: "max3_ min3_",
            domains: &[Normal; 3],
            run: |i, o| {
                o.f(max3_(i.v3(0))).f(min3_(i.v3(0)));
            },
        },
        Twin {
            name: "length3",
            domains: &[Bits; 3],
            run: |i, o| {
                o.f(length3(i.v3(0)));
            },
        },
        Twin {
            name: "normalize3",
            domains: &[Normal; 3],
            run: |i, o| {
                o.v3(normalize3(i.v3(0)));
            },
        },
    ],
};
