StringName(const char* p_utf8);
bool operator==(const char* p_other) const;
bool operator!=(const char* p_other) const;
