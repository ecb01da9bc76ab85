const Variant& operator[](const Variant& p_key) const;
Variant& operator[](const Variant& p_key);
