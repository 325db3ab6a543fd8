// The old place of tests/lab/closest.h.
#pragma once

#include "tests/lab/closest.h"
