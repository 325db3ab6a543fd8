// The old place of tests/lab/scenes.h.
#pragma once

#include "tests/lab/scenes.h"
