// The old place of tests/lab/test.h.
#pragma once

#include "tests/lab/test.h"
