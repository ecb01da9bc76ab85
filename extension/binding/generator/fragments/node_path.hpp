NodePath(const char* p_utf8);
