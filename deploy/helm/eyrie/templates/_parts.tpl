{{- define "eyrie.labels" -}}
app.kubernetes.io/name: {{ .Chart.Name }}
app.kubernetes.io/instance: {{ .Release.Name }}
app.kubernetes.io/version: {{ .Chart.AppVersion | quote }}
app.kubernetes.io/managed-by: {{ .Release.Service }}
{{- end }}

{{- define "eyrie.image" -}}
image: "{{ .Values.image.repository }}:{{ .Values.image.tag | default .Chart.AppVersion }}"
imagePullPolicy: {{ .Values.image.pullPolicy }}
{{- end }}

{{/* Nobody is root or may become it. */}}
{{- define "eyrie.podSecurity" -}}
runAsNonRoot: true
runAsUser: 10001
runAsGroup: 10001
fsGroup: 10001
seccompProfile: { type: RuntimeDefault }
{{- end }}

{{- define "eyrie.containerSecurity" -}}
readOnlyRootFilesystem: true
allowPrivilegeEscalation: false
capabilities: { drop: [ALL] }
{{- end }}

{{- define "eyrie.environment" -}}
{{- with .Values.data.credentialsSecret }}
envFrom:
  - secretRef: { name: {{ . | quote }} }
{{- end }}
{{- end }}

{{/* Who may come in. */}}
{{- define "eyrie.access" -}}
{{- if .Values.access.tokenSecret -}}
- --token-file=/run/eyrie/tokens
{{- else if .Values.access.insecure -}}
- --insecure
{{- else -}}
{{- fail "set access.tokenSecret, or access.insecure=true if everybody who reaches the pods may use them" }}
{{- end }}
{{- end }}

{{- define "eyrie.mounts" -}}
{{- if .Values.access.tokenSecret }}
- { name: access, mountPath: /run/eyrie, readOnly: true }
{{- end }}
- { name: tmp, mountPath: /tmp }
- { name: cache, mountPath: /cache }
{{- if .Values.data.existingClaim }}
- { name: data, mountPath: /data, readOnly: true }
{{- end }}
{{- end }}

{{- define "eyrie.volumes" -}}
{{- with .Values.access.tokenSecret }}
- name: access
  secret: { secretName: {{ . | quote }}, defaultMode: 0440 }
{{- end }}
- name: tmp
  emptyDir: { medium: Memory, sizeLimit: 256Mi }
- name: cache
  emptyDir: { sizeLimit: {{ .Values.data.cacheSize }} }
{{- with .Values.data.existingClaim }}
- name: data
  persistentVolumeClaim: { claimName: {{ . | quote }}, readOnly: true }
{{- end }}
{{- end }}
