DAFETF NAIF DAF ENCODED TRANSFER FILE
'DAF/CK  '
'2'
'6'
'seed                                                        '
BEGIN_ARRAY 1 24
'T                                       '
'0^0'
'258^3'
'-182B8'
'1'
'3'
'0'
24
'1^1'
'0^0'
'0^0'
'0^0'
'FEB897CD40BE08^0'
'0^0'
'0^0'
'198EAECB8BCB2C^0'
'FAE5A4ABBB13D^0'
'0^0'
'0^0'
'32DBFE467BA578^0'
'F490EEA1784DD^0'
'0^0'
'0^0'
'4BA73656EAE8D^0'
'0^0'
'64^2'
'C8^2'
'12C^3'
'0^0'
'C8^2'
'2^1'
'4^1'
END_ARRAY 1 24
TOTAL_ARRAYS 1
 ~NAIF/SPC BEGIN COMMENTS~
of the corpus
 ~NAIF/SPC END COMMENTS~
