// The old place of tests/lab/far.h.
#pragma once

#include "tests/lab/far.h"
