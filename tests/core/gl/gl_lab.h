// The old place of tests/lab/gl.h.
#pragma once

#include "tests/lab/gl.h"
