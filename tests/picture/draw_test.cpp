#include "picture/mosaic.hpp"
