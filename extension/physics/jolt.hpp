// The one way into Jolt's headers: inside physics/ only, never from a public header.
#pragma once

#include <Jolt/Jolt.h>
