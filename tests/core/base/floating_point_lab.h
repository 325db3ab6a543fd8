// The old place of tests/lab/floating_point.h.
#pragma once

#include "tests/lab/floating_point.h"
