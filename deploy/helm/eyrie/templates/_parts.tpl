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

{{/* The image asks for all GPUs, which it gets where NVIDIA's runtime is the node's default. */}}
{{- define "eyrie.withoutGpu" -}}
- { name: NVIDIA_VISIBLE_DEVICES, value: void }
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
{{- if .Values.access.tlsSecret }}
{{ include "eyrie.certificates" . }}
{{- end }}
{{- end }}

{{/* How processes are encrypted, and what `eyrie health` has to know to ask them. */}}
{{- define "eyrie.certificates" -}}
- --tls-cert=/run/eyrie-tls/tls.crt
- --tls-key=/run/eyrie-tls/tls.key
- --tls-ca=/run/eyrie-tls/ca.crt
- --tls-name={{ .Values.access.tlsName }}
{{- end }}

{{/* Kubernetes itself asks no gRPC service that is encrypted. */}}
{{- define "eyrie.rendererProbe" -}}
{{- if .Values.access.tlsSecret }}
exec:
  command:
    - eyrie
    - health
    - --quiet
    - 127.0.0.1:9090
    {{- include "eyrie.certificates" . | nindent 4 }}
{{- else }}
grpc: { port: 9090 }
{{- end }}
{{- end }}

{{- define "eyrie.pageProbe" -}}
httpGet: { path: /healthz, port: page, scheme: {{ if .Values.access.tlsSecret }}HTTPS{{ else }}HTTP{{ end }} }
{{- end }}

{{/* Of who may write to the data `writes` is true; so of the volumes below. */}}
{{- define "eyrie.mounts" -}}
{{- if .Values.access.tokenSecret }}
- { name: access, mountPath: /run/eyrie, readOnly: true }
{{- end }}
{{- if .Values.access.tlsSecret }}
- { name: certificates, mountPath: /run/eyrie-tls, readOnly: true }
{{- end }}
- { name: tmp, mountPath: /tmp }
- { name: cache, mountPath: /cache }
{{- if .Values.data.existingClaim }}
- { name: data, mountPath: /data, readOnly: {{ not .writes }} }
{{- end }}
{{- end }}

{{- define "eyrie.volumes" -}}
{{- with .Values.access.tokenSecret }}
- name: access
  secret: { secretName: {{ . | quote }}, defaultMode: 0440 }
{{- end }}
{{- with .Values.access.tlsSecret }}
- name: certificates
  secret: { secretName: {{ . | quote }}, defaultMode: 0440 }
{{- end }}
- name: tmp
  emptyDir: { medium: Memory, sizeLimit: 256Mi }
- name: cache
  emptyDir: { sizeLimit: {{ .Values.data.cacheSize }} }
{{- if .Values.data.existingClaim }}
- name: data
  persistentVolumeClaim: { claimName: {{ .Values.data.existingClaim | quote }}, readOnly: {{ not .writes }} }
{{- end }}
{{- end }}
