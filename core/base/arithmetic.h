// Every file of farcull demands this of the compiler's floating-point arithmetic; CMakeLists.txt
// includes it before anything else in each of them. The proofs are about IEEE 754: every operation
// is rounded once, to its own type, and infinities, NaNs, signed zeros and subnormals are numbers
// like others. What a thread does at run time is a matter of core/base/floating_point.h.
#pragma once

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ != 0) || \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || defined(__NO_SIGNED_ZEROS__)
#error "farcull: -ffast-math, -Ofast and their parts break its proofs; build without them"
#endif

#if !defined(__FLT_EVAL_METHOD__) || __FLT_EVAL_METHOD__ != 0
#error "farcull: operations must be rounded to their own type (FLT_EVAL_METHOD 0); build with SSE2"
#endif
