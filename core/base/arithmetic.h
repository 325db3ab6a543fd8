// Rejects compilers whose floating-point arithmetic does not match the proofs. CMakeLists.txt
// includes this file first in every file of farcull. The proofs assume IEEE 754: every operation is
// rounded once, to its own type, and infinities, NaNs, signed zeros and subnormals follow the
// standard. core/base/floating_point.h checks the arithmetic of a thread at run time.
#pragma once

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ != 0) || \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || defined(__NO_SIGNED_ZEROS__)
#error "farcull: -ffast-math, -Ofast and their parts break its proofs; build without them"
#endif

#if !defined(__FLT_EVAL_METHOD__) || __FLT_EVAL_METHOD__ != 0
#error "farcull: operations must be rounded to their own type (FLT_EVAL_METHOD 0); build with SSE2"
#endif
